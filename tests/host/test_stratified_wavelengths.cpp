#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "host/render/stratified_wavelengths.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/statistics.hpp"

using namespace stokes;

namespace {

using Strata = std::vector<std::uint32_t>;

constexpr int first_nm = 300, last_nm = 780;

// Wavelengths that are drawn almost always, and some that hardly ever are.
StratifiedWavelengths uneven() {
    std::vector<double> expected;
    for (int l = first_nm; l <= last_nm; ++l)
        expected.push_back(0.02 + std::exp(-0.01 * (l - 365) * (l - 365)) +
                           0.3 * std::exp(-0.001 * (l - 600) * (l - 600)));
    return {first_nm, expected};
}

// By trying all members for each place of the row: at a level, member a is drawn in band a / m, m members and
// strata in a band, and is in each of its strata with probability 1/m.
double enumerated_ratio(const Strata& row) {
    double ratio = 0.0;
    for (std::uint32_t level = 0; level < level_shares.size(); ++level) {
        const std::uint32_t m = 16u >> level;
        std::vector<std::uint32_t> members(row.size(), 0);
        double sum = 0.0;
        for (bool more = true; more;) {
            double p = 1.0;
            for (std::size_t i = 0; i < row.size(); ++i) {
                if (members[i] / m != row[i] / m) p = 0.0;
                if (std::count(members.begin(), members.end(), members[i]) > 1) p = 0.0;
                p /= m;
            }
            sum += p;
            more = false;
            for (std::uint32_t& member : members)
                if (++member < 16) {
                    more = true;
                    break;
                } else {
                    member = 0;
                }
        }
        ratio += level_shares[level] * sum;
    }
    return ratio;
}

}  // namespace

TEST_CASE("joint ratios are those of every way to draw a row", "[stratified_wavelengths]") {
    CHECK(joint_ratio({}) == Approx(1.0).epsilon(1e-14));
    for (std::uint32_t i = 0; i < 16; ++i) {
        CHECK(joint_ratio({i}) == Approx(1.0).epsilon(1e-14));
        for (std::uint32_t j = 0; j < 16; ++j) {
            CHECK(joint_ratio({i, j}) == Approx(enumerated_ratio({i, j})).epsilon(1e-13));
            CHECK(pair_ratio(i, j) == joint_ratio({i, j}));
        }
    }
    for (const Strata& row : {Strata{3, 3, 3}, Strata{2, 3, 3}, Strata{1, 2, 3}, Strata{0, 9, 8}, Strata{15, 0, 7},
                              Strata{5, 5, 5, 5}, Strata{12, 13, 12, 14}})
        CHECK(joint_ratio(row) == Approx(enumerated_ratio(row)).epsilon(1e-13));
    CHECK(joint_ratio(Strata(16, 4)) > 0.0);
    CHECK(joint_ratio(Strata(17, 4)) == 0.0);
}

// A set has 16 members, so that beside one there are 15, beside two 14 and so on: the sum over what comes
// next, each of the 16 strata one wide, is that many times the ratio of what is there.
TEST_CASE("given some members of a set, the others are the rest of sixteen", "[stratified_wavelengths]") {
    std::mt19937 generator(4);
    for (std::size_t k = 0; k < 16; ++k)
        for (int repeat = 0; repeat < 40; ++repeat) {
            Strata row(k);
            for (std::uint32_t& stratum : row)
                stratum = static_cast<std::uint32_t>(generator() % (repeat % 2 ? 16 : 4));
            double sum = 0.0;
            for (std::uint32_t next = 0; next < 16; ++next) {
                Strata longer = row;
                longer.push_back(next);
                sum += joint_ratio(longer);
            }
            CHECK(sum == Approx((16.0 - static_cast<double>(k)) * joint_ratio(row)).epsilon(1e-12));
        }
}

// Wavelengths that lie across the end of a stratum belong to both.
TEST_CASE("expected counts and pairs of wavelengths add up", "[stratified_wavelengths]") {
    const StratifiedWavelengths strata = uneven();
    const auto within = [&](int lambda, std::uint32_t s) {
        const double begin = strata.begin(lambda);
        return std::max(0.0, std::min(begin + strata.expected(lambda), s + 1.0) - std::max(begin, double(s)));
    };
    double sum = 0.0;
    for (int l = first_nm; l <= last_nm; ++l) sum += strata.expected(l);
    CHECK(sum == Approx(16.0).epsilon(1e-13));
    for (int i = first_nm; i <= last_nm; i += 7) {
        double own = 0.0, pairs = 0.0;
        for (std::uint32_t s = 0; s < 16; ++s) {
            own += within(i, s);
            if (within(i, s) > 0.0)
                for (int j = first_nm; j <= last_nm; ++j)
                    for (std::uint32_t t = 0; t < 16; ++t) pairs += within(i, s) * within(j, t) * pair_ratio(s, t);
        }
        CHECK(own == Approx(strata.expected(i)).epsilon(1e-12));
        CHECK(pairs == Approx(15.0 * strata.expected(i)).epsilon(1e-12));
    }
}

TEST_CASE("a set is in order and says where it is", "[stratified_wavelengths]") {
    const StratifiedWavelengths strata = uneven();
    for (std::uint32_t pass = 0; pass < 4000; ++pass) {
        const PassWavelengths w = strata.draw(11, pass < 2000 ? pass : 0u - (pass - 1999));
        REQUIRE(w.stratified);
        REQUIRE(w.set.front() >= first_nm);
        REQUIRE(w.set.back() <= last_nm);
        REQUIRE(std::is_sorted(w.set.begin(), w.set.end()));
        for (std::size_t k = 0; k < 16; ++k) {
            const double begin = strata.begin(w.set[k]), m = strata.expected(w.set[k]);
            REQUIRE(w.strata[k] < begin + m);
            REQUIRE(w.strata[k] + 1.0 > begin);
            REQUIRE(w.rarity[k] * m == Approx(16.0 / 481.0).epsilon(1e-12));
            REQUIRE(w.weight_nm(0, k) * m * pair_ratio(w.strata[0], w.strata[k]) == Approx(1.0).epsilon(1e-12));
        }
    }
    CHECK(strata.draw(3, 7).set == strata.draw(3, 7).set);
    CHECK(strata.draw(3, 7).set != strata.draw(3, 8).set);
    CHECK(strata.draw(3, 7).set != strata.draw(4, 7).set);
}

// Sets of different seeds are independent, those of one are not. One member of each, any of them alike, is an
// independent draw with probability expected / 16, and so are the strata of two of them with pair ratio / 240. Both
// tests together are wrong once in 1000.
TEST_CASE("wavelengths and pairs of strata are drawn as often as expected", "[stratified_wavelengths]") {
    constexpr std::uint32_t sets = 200000;
    const StratifiedWavelengths strata = uneven();
    std::mt19937_64 generator(9);
    std::vector<double> singles(last_nm - first_nm + 1, 0.0), single_means, pairs(256, 0.0), pair_means;
    for (std::uint32_t pass = 0; pass < sets; ++pass) {
        const PassWavelengths w = strata.draw(5 + pass, 1000 * pass);
        const std::uint64_t one = uniform_below(generator, 16), other = (one + 1 + uniform_below(generator, 15)) % 16;
        singles[static_cast<std::size_t>(w.set[one] - first_nm)] += 1.0;
        pairs[w.strata[one] * 16 + w.strata[other]] += 1.0;
    }
    for (int l = first_nm; l <= last_nm; ++l) single_means.push_back(sets * strata.expected(l) / 16.0);
    for (std::uint32_t i = 0; i < 256; ++i) pair_means.push_back(sets * pair_ratio(i / 16, i % 16) / 240.0);
    CHECK(chi_square_p_value(singles, single_means) > sidak_level(1e-3, 2));
    CHECK(chi_square_p_value(pairs, pair_means) > sidak_level(1e-3, 2));
}
