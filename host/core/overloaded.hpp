// One call operator for each alternative of a std::variant: std::visit does not compile where one is missing.
#pragma once

namespace stokes {

template <class... Functions>
struct Overloaded : Functions... {
    using Functions::operator()...;
};
template <class... Functions>
Overloaded(Functions...) -> Overloaded<Functions...>;

}  // namespace stokes
