#include "host/scene/bvh_split.hpp"

#include <algorithm>
#include <cstddef>

namespace stokes {

namespace {

constexpr int bin_count = 32;

struct Bin {
    BvhBox box;
    std::uint32_t count = 0;

    void add(const Bin& other) {
        box.add(other.box);
        count += other.count;
    }
    double cost() const { return count == 0 ? 0.0 : box.half_area() * ((count + 7) / 8); }
};

// Maps twice the centre of a box on one axis to a bin; the same arithmetic bins and partitions.
struct Binning {
    float first = 0.0f, scale = 0.0f;  // scale 0: all centres coincide

    int bin(const BvhBox& box, std::size_t axis) const {
        const float position = (box.lo[axis] + box.hi[axis] - first) * scale;
        return std::clamp(static_cast<int>(position), 0, bin_count - 1);
    }
};

// lo and hi: extremes of twice the centres.
BvhBox bound_centres(const std::vector<BvhRef>& refs, const BvhRange& range) {
    BvhBox bounds;
    for (std::uint32_t i = range.begin; i < range.end; ++i)
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const float centre = refs[i].box.lo[axis] + refs[i].box.hi[axis];
            bounds.lo[axis] = std::min(bounds.lo[axis], centre);
            bounds.hi[axis] = std::max(bounds.hi[axis], centre);
        }
    return bounds;
}

std::array<Binning, 3> make_binnings(const BvhBox& centres) {
    std::array<Binning, 3> binnings;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const float spread = centres.hi[axis] - centres.lo[axis];
        const float scale = static_cast<float>(bin_count) / spread;
        binnings[axis] = {centres.lo[axis], spread > 0.0f && scale < BvhBox::infinity ? scale : 0.0f};
    }
    return binnings;
}

struct Plane {
    double cost = std::numeric_limits<double>::infinity();
    std::size_t axis = 0;
    int bin = 0;  // bins below it go left
};

void find_best_plane(const std::array<Bin, bin_count>& bins, std::size_t axis, Plane& best) {
    std::array<double, bin_count> right_cost{};
    Bin right;
    for (int i = bin_count - 1; i > 0; --i) {
        right.add(bins[i]);
        right_cost[i] = right.count == 0 ? Plane().cost : right.cost();
    }
    Bin left;
    for (int i = 1; i < bin_count; ++i) {
        left.add(bins[i - 1]);
        if (left.count == 0) continue;
        const double cost = left.cost() + right_cost[i];
        if (cost < best.cost) best = {cost, axis, i};
    }
}

}  // namespace

void BvhBox::add(const BvhBox& other) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
        lo[axis] = std::min(lo[axis], other.lo[axis]);
        hi[axis] = std::max(hi[axis], other.hi[axis]);
    }
}

double BvhBox::half_area() const {
    if (!(lo[0] <= hi[0])) return 0.0;
    const double x = static_cast<double>(hi[0]) - lo[0];
    const double y = static_cast<double>(hi[1]) - lo[1];
    const double z = static_cast<double>(hi[2]) - lo[2];
    return x * y + y * z + z * x;
}

BvhRange make_range(const std::vector<BvhRef>& refs, std::uint32_t begin, std::uint32_t end) {
    BvhRange range{begin, end, {}};
    for (std::uint32_t i = begin; i < end; ++i) range.box.add(refs[i].box);
    return range;
}

std::pair<BvhRange, BvhRange> split_by_area(std::vector<BvhRef>& refs, const BvhRange& range) {
    const std::array<Binning, 3> binnings = make_binnings(bound_centres(refs, range));
    std::array<std::array<Bin, bin_count>, 3> bins;
    for (std::uint32_t i = range.begin; i < range.end; ++i)
        for (std::size_t axis = 0; axis < 3; ++axis) {
            Bin& bin = bins[axis][binnings[axis].bin(refs[i].box, axis)];
            bin.box.add(refs[i].box);
            ++bin.count;
        }
    Plane best;
    for (std::size_t axis = 0; axis < 3; ++axis)
        if (binnings[axis].scale > 0.0f) find_best_plane(bins[axis], axis, best);
    if (!(best.cost < Plane().cost)) return split_evenly(refs, range);

    const Binning binning = binnings[best.axis];
    const auto first = refs.begin() + range.begin;
    const auto middle = std::partition(first, refs.begin() + range.end, [&](const BvhRef& ref) {
        return binning.bin(ref.box, best.axis) < best.bin;
    });
    const std::uint32_t mid = range.begin + static_cast<std::uint32_t>(middle - first);
    std::pair<BvhRange, BvhRange> parts{{range.begin, mid, {}}, {mid, range.end, {}}};
    for (int i = 0; i < bin_count; ++i)
        (i < best.bin ? parts.first : parts.second).box.add(bins[best.axis][i].box);
    return parts;
}

std::pair<BvhRange, BvhRange> split_evenly(std::vector<BvhRef>& refs, const BvhRange& range) {
    const BvhBox centres = bound_centres(refs, range);
    std::size_t axis = 0;
    for (std::size_t i = 1; i < 3; ++i)
        if (centres.hi[i] - centres.lo[i] > centres.hi[axis] - centres.lo[axis]) axis = i;
    const std::uint32_t mid = range.begin + range.blocks() / 2 * 8;
    const auto first = refs.begin();
    std::nth_element(first + range.begin, first + mid, first + range.end,
                     [axis](const BvhRef& a, const BvhRef& b) {
                         const float at_a = a.box.lo[axis] + a.box.hi[axis];
                         const float at_b = b.box.lo[axis] + b.box.hi[axis];
                         return at_a < at_b || (at_a == at_b && a.triangle < b.triangle);
                     });
    return {make_range(refs, range.begin, mid), make_range(refs, mid, range.end)};
}

}  // namespace stokes
