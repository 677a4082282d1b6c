#include "host/scene/bvh/bvh_spatial.hpp"

#include <algorithm>
#include <array>

#include "host/scene/bvh/bvh_parallel.hpp"

namespace stokes {

namespace {

constexpr int bin_count = 16;

// Refs that begin in a bin, refs that end in it, and the box of all parts in it.
struct Bin {
    BvhBox box;
    std::uint32_t begins = 0, ends = 0;

    void add(const Bin& other) {
        box.add(other.box);
        begins += other.begins;
        ends += other.ends;
    }
};
using Bins = std::array<Bin, bin_count>;

using Planes = std::array<float, bin_count - 1>;

// Evenly spaced; false when there is no room for them.
bool make_planes(const BvhBox& box, std::size_t axis, double slack_mm, Planes& planes) {
    const double lo = box.lo[axis], step = (box.hi[axis] - lo) / bin_count;
    if (!(step > 4.0 * slack_mm)) return false;
    float last = box.lo[axis];
    for (int i = 0; i < bin_count - 1; ++i) {
        planes[i] = static_cast<float>(lo + step * (i + 1));
        if (!(planes[i] > last && planes[i] < box.hi[axis])) return false;
        last = planes[i];
    }
    return true;
}

Bins fill_bins(const BvhSet& set, const BvhClipper& clipper, std::size_t axis, const Planes& planes,
               std::uint32_t begin, std::uint32_t end) {
    Bins bins;
    std::array<BvhBox, bin_count> parts;
    for (std::uint32_t i = begin; i < end; ++i) {
        const BvhRef& ref = set.ref(i);
        // Planes with lo < plane < hi cut the ref.
        const float lo = ref.box.lo[axis], hi = ref.box.hi[axis];
        const auto first = std::upper_bound(planes.begin(), planes.end(), lo) - planes.begin();
        const auto last = std::lower_bound(planes.begin() + first, planes.end(), hi) - planes.begin();
        ++bins[first].begins;
        ++bins[last].ends;
        if (first == last) {
            bins[first].box.add(ref.box);
            continue;
        }
        clipper.cut(ref, axis, planes.data() + first, static_cast<int>(last - first), parts.data());
        for (auto k = first; k <= last; ++k) bins[k].box.add(parts[k - first]);
    }
    return bins;
}

void find_best_plane(const BvhSet& set, const Bins& bins, std::size_t axis, const Planes& planes, SpatialSplit& best) {
    const auto right = sums_from_each_bin(bins);
    Bin left;
    for (int i = 1; i < bin_count; ++i) {
        left.add(bins[i - 1]);
        const std::uint32_t left_count = left.begins, right_count = right[i].ends;
        if (left_count == 0 || right_count == 0 || left_count == set.count() || right_count == set.count()) continue;
        if (std::uint64_t{left_count} + right_count > set.count() + set.spare) continue;
        const double cost = split_cost(left.box, left_count, right[i].box, right_count);
        if (cost < best.cost) best = {cost, axis, planes[i - 1], left.box, right[i].box, left_count, right_count};
    }
}

// Where a ref goes: its parts, empty for a side that gets none.
struct Sides {
    BvhBox left, right;
};

class Divider {
  public:
    Divider(const SpatialSplit& split, const BvhClipper& clipper)
        : split_(split), clipper_(clipper), left_area_(split.left.half_area()), right_area_(split.right.half_area()) {}

    Sides divide(const BvhRef& ref) const {
        if (ref.box.lo[split_.axis] >= split_.plane_mm) return {{}, ref.box};
        if (ref.box.hi[split_.axis] <= split_.plane_mm) return {ref.box, {}};
        std::array<BvhBox, 2> parts;
        clipper_.cut(ref, split_.axis, &split_.plane_mm, 1, parts.data());
        if (parts[0].empty()) return {{}, ref.box};
        if (parts[1].empty()) return {ref.box, {}};
        // Costs with refs as the unit: whether blocks are full is not known yet.
        const double left_growth = (grown(split_.left, ref.box) - left_area_) * split_.left_count;
        const double right_growth = (grown(split_.right, ref.box) - right_area_) * split_.right_count;
        const double in_both = 0.0, in_left = left_growth - right_area_, in_right = right_growth - left_area_;
        if (in_left < in_both && in_left <= in_right) return {ref.box, {}};
        if (in_right < in_both) return {{}, ref.box};
        return {parts[0], parts[1]};
    }

  private:
    static double grown(BvhBox box, const BvhBox& more) {
        box.add(more);
        return box.half_area();
    }
    const SpatialSplit& split_;
    const BvhClipper& clipper_;
    double left_area_, right_area_;
};

struct Side {
    BvhBox box;
    std::uint32_t count = 0;

    void add(const BvhBox& part) {
        if (part.empty()) return;
        box.add(part);
        ++count;
    }
};

}  // namespace

SpatialSplit find_spatial_split(const BvhSet& set, const BvhClipper& clipper, unsigned threads) {
    SpatialSplit best;
    const auto chunks = make_chunks(threads, set.begin, set.end);
    for (std::size_t axis = 0; axis < 3; ++axis) {
        Planes planes;
        if (!make_planes(set.box, axis, clipper.slack_mm(), planes)) continue;
        auto parts = run_chunks<Bins>(threads, chunks, [&](std::uint32_t begin, std::uint32_t end) {
            return fill_bins(set, clipper, axis, planes, begin, end);
        });
        for (std::size_t part = 1; part < parts.size(); ++part)
            for (std::size_t i = 0; i < bin_count; ++i) parts[0][i].add(parts[part][i]);
        find_best_plane(set, parts[0], axis, planes, best);
    }
    return best;
}

bool apply_split(const BvhSet& set, const SpatialSplit& split, const BvhClipper& clipper, double limit,
                 unsigned threads, BvhHalves& halves) {
    const Divider divider(split, clipper);
    const auto chunks = make_chunks(threads, set.begin, set.end);
    using Both = std::pair<Side, Side>;
    const auto parts = run_chunks<Both>(threads, chunks, [&](std::uint32_t begin, std::uint32_t end) {
        Both both;
        for (std::uint32_t i = begin; i < end; ++i) {
            const Sides sides = divider.divide(set.ref(i));
            both.first.add(sides.left);
            both.second.add(sides.right);
        }
        return both;
    });
    Side left, right;
    for (const Both& part : parts) {
        left.box.add(part.first.box), left.count += part.first.count;
        right.box.add(part.second.box), right.count += part.second.count;
    }
    const std::uint64_t total = std::uint64_t{left.count} + right.count;
    if (left.count == 0 || right.count == 0 || left.count == set.count() || right.count == set.count() ||
        total > set.count() + set.spare || !(split_cost(left.box, left.count, right.box, right.count) < limit))
        return false;

    auto out = std::make_shared<std::vector<BvhRef>>(total);
    run_parallel(threads, chunks.size(), [&](std::size_t chunk) {
        std::uint32_t to_left = 0, to_right = left.count;
        for (std::size_t before = 0; before < chunk; ++before) {
            to_left += parts[before].first.count;
            to_right += parts[before].second.count;
        }
        for (std::uint32_t i = chunks[chunk].first; i < chunks[chunk].second; ++i) {
            const Sides sides = divider.divide(set.ref(i));
            if (!sides.left.empty()) (*out)[to_left++] = {sides.left, set.ref(i).triangle};
            if (!sides.right.empty()) (*out)[to_right++] = {sides.right, set.ref(i).triangle};
        }
    });
    const auto end = static_cast<std::uint32_t>(total);
    halves = {{out, 0, left.count, left.box, 0}, {out, left.count, end, right.box, 0}};
    return true;
}

}  // namespace stokes
