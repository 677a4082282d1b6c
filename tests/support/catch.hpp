// The one place that knows which Catch2 this is: 2.x as Debian 12 has it, or 3.x.
#pragma once

#if defined(__has_include)
#if __has_include(<catch2/catch_all.hpp>)
#include <catch2/catch_all.hpp>
using Catch::Approx;
#else
#include <catch2/catch.hpp>
#endif
#endif
