#include "host/render/emission_cells.hpp"

#include <algorithm>
#include <cmath>
#include <queue>
#include <random>
#include <tuple>
#include <utility>

namespace stokes {

namespace {

// Slices along a coordinate by which the worth of a cut is judged: two alone would not see what lies in the middle.
constexpr std::size_t slices = 4;

// A cell with fewer samples is not cut, and one counts this many samples of its parent's density beside its own: of
// trial photons, which lie evenly, none of seeds, which lie only where there is something.
constexpr std::size_t least_samples = 48;
constexpr double parent_samples_of_trials = 12.0, parent_samples_of_seeds = 0.0;

// Cuts that lessen the root of the variance by a smaller share are not made.
constexpr double least_gain = 1e-5;

constexpr float smallest_edge = 0x1p-16f;

double root(double volume, double square) { return std::sqrt(volume * square); }

}  // namespace

struct EmissionCells::Box {
    std::uint32_t light = 0;
    std::array<float, 4> low{0.0f, 0.0f, 0.0f, 0.0f}, size{1.0f, 1.0f, 1.0f, 1.0f};
    double volume = 0.0;             // probability under random emission
    double square = 0.0;             // share of the mean square
    std::size_t begin = 0, end = 0;  // samples
    std::size_t cut = 0;             // the coordinate along which to cut it
    double gain = 0.0;
};

class EmissionCells::Partition {
  public:
    Partition(const std::vector<EmittingLight>& lights, const std::vector<EmissionSample>& samples,
              double parent_samples)
        : lights_(lights), samples_(samples), parent_samples_(parent_samples) {
        std::stable_sort(samples_.begin(), samples_.end(),
                         [](const EmissionSample& a, const EmissionSample& b) { return a.light < b.light; });
        std::size_t at = 0;
        for (std::uint32_t i = 0; i < lights.size(); ++i) {
            Box box;
            box.light = i;
            box.volume = lights[i].probability;
            box.begin = at;
            while (at < samples_.size() && samples_[at].light == i) box.square += samples_[at++].square;
            box.end = at;
            if (!(box.volume > 0.0)) continue;
            add_cut_out(box);
        }
        for (Box& box : boxes_) {
            judge(box);
            all_ += root(box.volume, box.square);
        }
    }

    std::vector<Box> cut(std::size_t most) {
        const auto less = [&](std::size_t a, std::size_t b) {
            return boxes_[a].gain != boxes_[b].gain ? boxes_[a].gain < boxes_[b].gain : a > b;
        };
        std::priority_queue<std::size_t, std::vector<std::size_t>, decltype(less)> queue(less);
        for (std::size_t i = 0; i < boxes_.size(); ++i) queue.push(i);
        while (!queue.empty() && boxes_.size() < most) {
            const std::size_t i = queue.top();
            queue.pop();
            if (!(boxes_[i].gain > least_gain * all_)) break;
            halve(i);
            queue.push(i);
            queue.push(boxes_.size() - 1);
        }
        return boxes_;
    }

  private:
    // The light's region, and what lies beside it along each coordinate.
    void add_cut_out(Box inner) {
        const EmittingLight& light = lights_[inner.light];
        for (std::size_t d = 0; d < light.dimensions; ++d) {
            if (light.region_low[d] > 0.0f) {
                const auto [low, high] = parts(inner, d, light.region_low[d]);
                boxes_.push_back(low);
                inner = high;
            }
            if (light.region_high[d] < 1.0f) {
                const auto [low, high] = parts(inner, d, light.region_high[d]);
                boxes_.push_back(high);
                inner = low;
            }
        }
        boxes_.push_back(inner);
    }

    // What a cut would gain along each coordinate, and the best.
    void judge(Box& box) const {
        box.gain = 0.0;
        if (box.end - box.begin < least_samples) return;
        const std::size_t dimensions = lights_[box.light].dimensions;
        std::array<std::array<double, slices>, 4> square{}, count{};
        for (std::size_t i = box.begin; i < box.end; ++i)
            for (std::size_t d = 0; d < dimensions; ++d) {
                const float along = (samples_[i].place[d] - box.low[d]) / box.size[d] * static_cast<float>(slices);
                const auto slice = static_cast<std::size_t>(std::clamp(along, 0.0f, static_cast<float>(slices) - 1.0f));
                square[d][slice] += samples_[i].square;
                count[d][slice] += 1.0;
            }
        for (std::size_t d = 0; d < dimensions; ++d) {
            if (box.size[d] <= smallest_edge) continue;
            double after = 0.0;
            for (std::size_t s = 0; s < slices; ++s)
                after += root(box.volume / slices, damped(square[d][s], count[d][s], box.square / slices));
            const double gain = root(box.volume, box.square) - after;
            if (gain > box.gain) box.gain = gain, box.cut = d;
        }
    }

    // A part's share of the square from its own samples and from what its parent lets expect.
    double damped(double square, double count, double expected) const {
        const double all = count + parent_samples_;
        return all > 0.0 ? (count * square + parent_samples_ * expected) / all : 0.0;
    }

    // Box i becomes its lower half, the upper half is added.
    void halve(std::size_t i) {
        const std::size_t d = boxes_[i].cut;
        auto [low, high] = parts(boxes_[i], d, boxes_[i].low[d] + 0.5f * boxes_[i].size[d]);
        judge(low), judge(high);
        boxes_[i] = low;
        boxes_.push_back(high);
    }

    // Below and above a place along coordinate d, with the samples of each.
    std::pair<Box, Box> parts(const Box& whole, std::size_t d, float place) {
        const auto first = samples_.begin() + static_cast<std::ptrdiff_t>(whole.begin);
        const auto last = samples_.begin() + static_cast<std::ptrdiff_t>(whole.end);
        const auto upper =
            std::stable_partition(first, last, [&](const EmissionSample& sample) { return sample.place[d] < place; });
        std::pair<Box, Box> two = {whole, whole};
        two.first.end = two.second.begin = static_cast<std::size_t>(upper - samples_.begin());
        two.second.low[d] = place;
        two.first.size[d] = place - whole.low[d];
        two.second.size[d] = whole.low[d] + whole.size[d] - place;
        for (Box* part : {&two.first, &two.second}) {
            const double share = static_cast<double>(part->size[d]) / static_cast<double>(whole.size[d]);
            part->volume = share * whole.volume;
            double square = 0.0;
            for (std::size_t k = part->begin; k < part->end; ++k) square += samples_[k].square;
            part->square = damped(square, static_cast<double>(part->end - part->begin), share * whole.square);
        }
        return two;
    }

    const std::vector<EmittingLight>& lights_;
    std::vector<EmissionSample> samples_;
    double parent_samples_;
    std::vector<Box> boxes_;
    double all_ = 0.0;
};

// Each cell has at least one photon in every pass.
constexpr double least_photons = 1.5;

EmissionCell EmissionCells::record_of(const Box& box, double photons) {
    EmissionCell cell{};
    std::copy(box.low.begin(), box.low.end(), cell.low);
    std::copy(box.size.begin(), box.size.end(), cell.size);
    cell.light = box.light;
    cell.probability = static_cast<float>(box.volume);
    cell.stride = static_cast<std::uint32_t>(std::floor(photons)) + 1;
    return cell;
}

EmissionCells EmissionCells::stratified(const std::vector<EmittingLight>& lights, std::uint32_t photons) {
    return aimed(lights, {}, 1.0, lights.size(), photons);
}

EmissionCells EmissionCells::aimed(const std::vector<EmittingLight>& lights, const std::vector<EmissionSample>& samples,
                                   double uniform_share, std::size_t most_cells, std::uint32_t photons) {
    return of_boxes(
        Partition(lights, samples, parent_samples_of_trials).cut(std::min<std::size_t>(most_cells, photons / 3)),
        uniform_share, photons);
}

EmissionCells EmissionCells::seeded(const std::vector<EmittingLight>& lights, const std::vector<EmissionSample>& seeds,
                                    double uniform_share, std::size_t most_cells, std::uint32_t photons) {
    return of_boxes(
        Partition(lights, seeds, parent_samples_of_seeds).cut(std::min<std::size_t>(most_cells, photons / 3)),
        uniform_share, photons);
}

EmissionCells EmissionCells::of_boxes(std::vector<Box> boxes, double uniform_share, std::uint32_t photons) {
    const double least_share = least_photons / photons, rest = 1.0 - least_share * static_cast<double>(boxes.size());
    if (rest < 0.5) return {};
    // Cells in order of place lie side by side in memory, so that neighbouring work-items do the same.
    std::stable_sort(boxes.begin(), boxes.end(),
                     [](const Box& a, const Box& b) { return std::tie(a.light, a.low) < std::tie(b.light, b.low); });
    double volume = 0.0, roots = 0.0;
    for (const Box& box : boxes) {
        volume += box.volume;
        roots += root(box.volume, box.square);
    }
    EmissionCells cells;
    cells.photons_ = photons;
    for (Box& box : boxes) {
        const double aimed = roots > 0.0 ? root(box.volume, box.square) / roots : box.volume / volume;
        box.volume /= volume;
        cells.shares_.push_back(least_share + rest * (uniform_share * box.volume + (1.0 - uniform_share) * aimed));
        cells.records_.push_back(record_of(box, cells.shares_.back() * photons));
    }
    return cells;
}

// Systematic sampling: the shares side by side on a line of this length, and a photon at each whole number plus an
// offset. The offset goes on by the golden section from pass to pass.
std::vector<std::uint32_t> EmissionCells::first_photons(std::uint32_t seed, std::uint32_t pass) const {
    std::seed_seq sequence{seed, 0xe3155u};
    std::mt19937_64 generator(sequence);
    const double start = static_cast<double>(generator() >> 11) * 0x1p-53;
    const double offset = std::fmod(start + pass * 0.61803398874989485, 1.0);
    std::vector<std::uint32_t> first(shares_.size() + 1, 0);
    double sum = 0.0;
    for (std::size_t c = 0; c + 1 < shares_.size(); ++c) {
        sum += shares_[c];
        first[c + 1] =
            static_cast<std::uint32_t>(std::clamp(std::floor(sum * photons_ + offset), 0.0, double(photons_)));
    }
    first.back() = photons_;
    return first;
}

}  // namespace stokes
