#include "host/scene/bvh/bvh_split.hpp"

#include <algorithm>

#include "host/scene/bvh/bvh_parallel.hpp"

namespace stokes {

namespace {

constexpr int bin_count = BvhBinning::bins;

struct Bin {
    BvhBox box;
    std::uint32_t count = 0;

    void add(const Bin& other) {
        box.add(other.box);
        count += other.count;
    }
};
using Bins = std::array<std::array<Bin, bin_count>, 3>;

// lo and hi: extremes of twice the centres.
BvhBox bound_centres(const BvhSet& set, unsigned threads) {
    const auto chunks = make_chunks(threads, set.begin, set.end);
    BvhBox bounds;
    for (const BvhBox& part : run_chunks<BvhBox>(threads, chunks, [&](std::uint32_t begin, std::uint32_t end) {
             BvhBox box;
             for (std::uint32_t i = begin; i < end; ++i)
                 for (std::size_t axis = 0; axis < 3; ++axis) {
                     const float centre = set.ref(i).box.lo[axis] + set.ref(i).box.hi[axis];
                     box.lo[axis] = std::min(box.lo[axis], centre);
                     box.hi[axis] = std::max(box.hi[axis], centre);
                 }
             return box;
         }))
        bounds.add(part);
    return bounds;
}

std::array<BvhBinning, 3> make_binnings(const BvhBox& centres) {
    std::array<BvhBinning, 3> binnings;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const float spread = centres.hi[axis] - centres.lo[axis];
        const float scale = static_cast<float>(bin_count) / spread;
        binnings[axis] = {centres.lo[axis], spread > 0.0f && scale < BvhBox::infinity ? scale : 0.0f};
    }
    return binnings;
}

Bins fill_bins(const BvhSet& set, const std::array<BvhBinning, 3>& binnings, unsigned threads) {
    const auto chunks = make_chunks(threads, set.begin, set.end);
    auto parts = run_chunks<Bins>(threads, chunks, [&](std::uint32_t begin, std::uint32_t end) {
        Bins bins;
        for (std::uint32_t i = begin; i < end; ++i)
            for (std::size_t axis = 0; axis < 3; ++axis) {
                const BvhBox& box = set.ref(i).box;
                Bin& bin = bins[axis][binnings[axis].bin(box, axis)];
                bin.box.add(box);
                ++bin.count;
            }
        return bins;
    });
    for (std::size_t part = 1; part < parts.size(); ++part)
        for (std::size_t axis = 0; axis < 3; ++axis)
            for (std::size_t i = 0; i < bin_count; ++i) parts[0][axis][i].add(parts[part][axis][i]);
    return parts[0];
}

void find_best_plane(const std::array<Bin, bin_count>& bins, std::size_t axis, ObjectSplit& best) {
    const auto right = sums_from_each_bin(bins);
    Bin left;
    for (int i = 1; i < bin_count; ++i) {
        left.add(bins[i - 1]);
        if (left.count == 0 || right[i].count == 0) continue;
        const double cost = split_cost(left.box, left.count, right[i].box, right[i].count);
        if (cost < best.cost) best = {cost, axis, i, {}, left.box, right[i].box};
    }
}

// A stable partition of the refs from one storage to another.
template <class GoesLeft>
std::uint32_t partition_to(const BvhSet& set, std::vector<BvhRef>& out, const GoesLeft& goes_left, unsigned threads) {
    const auto chunks = make_chunks(threads, set.begin, set.end);
    const auto lefts = run_chunks<std::uint32_t>(threads, chunks, [&](std::uint32_t begin, std::uint32_t end) {
        std::uint32_t count = 0;
        for (std::uint32_t i = begin; i < end; ++i) count += goes_left(set.ref(i)) ? 1 : 0;
        return count;
    });
    std::uint32_t middle = 0;
    for (const std::uint32_t count : lefts) middle += count;
    run_parallel(threads, chunks.size(), [&](std::size_t chunk) {
        std::uint32_t left = 0;
        for (std::size_t before = 0; before < chunk; ++before) left += lefts[before];
        std::uint32_t right = middle + (chunks[chunk].first - set.begin) - left;
        for (std::uint32_t i = chunks[chunk].first; i < chunks[chunk].second; ++i)
            out[goes_left(set.ref(i)) ? left++ : right++] = set.ref(i);
    });
    return middle;
}

template <class GoesLeft>
BvhHalves partition(BvhSet set, const GoesLeft& goes_left, unsigned threads) {
    std::uint32_t middle = 0;
    if (threads > 1) {
        auto out = std::make_shared<std::vector<BvhRef>>(set.count());
        middle = partition_to(set, *out, goes_left, threads);
        set = {std::move(out), 0, set.count(), set.box, set.spare};
    } else {
        const auto first = set.storage->begin();
        middle =
            static_cast<std::uint32_t>(std::stable_partition(first + set.begin, first + set.end, goes_left) - first);
    }
    return {{set.storage, set.begin, middle, {}, 0}, {set.storage, middle, set.end, {}, 0}};
}

}  // namespace

void BvhBox::add(const BvhBox& other) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
        lo[axis] = std::min(lo[axis], other.lo[axis]);
        hi[axis] = std::max(hi[axis], other.hi[axis]);
    }
}

void BvhBox::cut(const BvhBox& other) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
        lo[axis] = std::max(lo[axis], other.lo[axis]);
        hi[axis] = std::min(hi[axis], other.hi[axis]);
    }
}

double BvhBox::half_area() const {
    if (empty()) return 0.0;
    const double x = static_cast<double>(hi[0]) - lo[0];
    const double y = static_cast<double>(hi[1]) - lo[1];
    const double z = static_cast<double>(hi[2]) - lo[2];
    return x * y + y * z + z * x;
}

double split_cost(const BvhBox& left, std::uint32_t left_count, const BvhBox& right, std::uint32_t right_count) {
    return left.half_area() * ((left_count + 7) / 8) + right.half_area() * ((right_count + 7) / 8);
}

int BvhBinning::bin(const BvhBox& box, std::size_t axis) const {
    const float position = (box.lo[axis] + box.hi[axis] - first) * scale;
    return std::clamp(static_cast<int>(position), 0, bins - 1);
}

ObjectSplit find_object_split(const BvhSet& set, unsigned threads) {
    const std::array<BvhBinning, 3> binnings = make_binnings(bound_centres(set, threads));
    const Bins bins = fill_bins(set, binnings, threads);
    ObjectSplit best;
    for (std::size_t axis = 0; axis < 3; ++axis)
        if (binnings[axis].scale > 0.0f) find_best_plane(bins[axis], axis, best);
    best.binning = binnings[best.axis];
    return best;
}

BvhHalves apply_split(BvhSet set, const ObjectSplit& split, unsigned threads) {
    const auto goes_left = [&](const BvhRef& ref) { return split.binning.bin(ref.box, split.axis) < split.bin; };
    BvhHalves halves = partition(std::move(set), goes_left, threads);
    halves.first.box = split.left;
    halves.second.box = split.right;
    return halves;
}

BvhHalves split_evenly(BvhSet set) {
    const BvhBox centres = bound_centres(set, 1);
    std::size_t axis = 0;
    for (std::size_t i = 1; i < 3; ++i)
        if (centres.hi[i] - centres.lo[i] > centres.hi[axis] - centres.lo[axis]) axis = i;
    const auto before = [axis](const BvhRef& a, const BvhRef& b) {
        const float at_a = a.box.lo[axis] + a.box.hi[axis];
        const float at_b = b.box.lo[axis] + b.box.hi[axis];
        return at_a < at_b || (at_a == at_b && a.triangle < b.triangle);
    };
    std::vector<BvhRef> sorted(set.storage->begin() + set.begin, set.storage->begin() + set.end);
    const auto middle = sorted.begin() + set.blocks() / 2 * 8;
    std::nth_element(sorted.begin(), middle, sorted.end(), before);
    BvhHalves halves = partition(
        std::move(set), [&, at = *middle](const BvhRef& ref) { return before(ref, at); }, 1);
    for (BvhSet* half : {&halves.first, &halves.second})
        for (std::uint32_t i = half->begin; i < half->end; ++i) half->box.add(half->ref(i).box);
    return halves;
}

}  // namespace stokes
