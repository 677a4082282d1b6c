"""From renders to numbers.

The error of a picture P is measured against the mean T of independent renders. E|P - T|^2 = E|P - E T|^2 +
E|T - E T|^2; the second term, known from how the renders of T differ, is taken off, and what is left is the mean square
error (MSE) against the limit of T, over pixels and over X, Y and Z. Standard errors are jackknifes over the seeds, with
what is uncertain in the second term added in quadrature."""

import csv
import dataclasses

import numpy as np

from convergence_lib import pictures, statistics
from convergence_lib.samplers import OTHER_KERNEL, PLAIN

FIRST_PASSES = 4  # where slopes begin: a few passes see few wavelengths
COMPARED_ROWS = 4  # the last powers of two, over which samplers are compared


@dataclasses.dataclass
class Truth:
    """images: layer -> [height, width, 3] XYZ; variance and its standard error, by layer."""

    images: dict
    variance: dict
    variance_error: dict

    def __init__(self, parts):
        """parts: layers of Rec. 709, as merge() gives them."""
        stacks = {
            name: np.array([part[layer] for part in parts]) @ pictures.XYZ_OF_RGB.T
            for name, layer in pictures.LAYERS.items()
        }
        self.images = {name: stack.mean(axis=0) for name, stack in stacks.items()}
        self.level = {name: pictures.mean_level(image) for name, image in self.images.items()}
        self.variance, self.variance_error = {}, {}
        for name, stack in stacks.items():
            flat = stack.reshape(len(stack), -1)
            self.variance[name], self.variance_error[name] = statistics.variance_of_mean(flat)

    @property
    def layers(self):
        """Those that are not black."""
        return [name for name in pictures.LAYERS if self.level[name] > 0]

    def numbers(self):
        return {
            name: {
                "mean_cd_m2": self.level[name],
                "relative_rmse": self.variance[name] ** 0.5 / self.level[name],
            }
            for name in self.layers
        }


class Curves:
    """Of one sampler in one scene: results of all seeds, in order."""

    def __init__(self, results):
        rows = []
        for result in results:
            with open(result.curve, encoding="utf-8", newline="") as file:
                rows.append(list(csv.DictReader(file)))
        self.passes = np.array([int(row["passes"]) for row in rows[0]])
        self.square = {
            name: np.array([[float(row[f"rmse_{name}"]) ** 2 for row in seed] for seed in rows])
            for name in pictures.LAYERS
        }  # [seeds, rows], the truth's error included
        # The trial passes of set-up included, at the share of the passes' time that they take of the processor's.
        trials = np.array([result.stats.get("trials_processor_s", 0) for result in results])
        passes = np.array([result.stats["processor_s"] for result in results])
        self.processor_s = passes + trials
        self.wall_s = np.array([result.stats["wall_s"] for result in results]) * self.processor_s / passes
        wall = np.array([[float(row["seconds"]) for row in seed] for seed in rows])
        # Of each row: that of the render, shared out by the wall time of the passes.
        self.seconds = np.mean(wall / wall[:, -1:] * self.processor_s[:, None], axis=0)
        self.images = [pictures.xyz(result.picture()) for result in results]

    @property
    def seeds(self):
        return len(self.processor_s)

    def late(self):
        return self.passes >= min(FIRST_PASSES, self.passes[-1] / 4)

    def log_mse(self, layer, seeds, variance):
        """Of the mean over the seeds, by row; nan where the truth's variance is not exceeded."""
        mse = self.square[layer][seeds].mean(axis=0) - variance
        return np.log(np.where(mse > 0, mse, np.nan))


def with_truth(function, seeds, variance, error):
    """Values and standard errors of function(seeds, variance of the truth)."""
    values, own = statistics.jackknife(lambda chosen: function(chosen, variance), seeds)
    everything = np.arange(seeds)
    low, high = (np.asarray(function(everything, max(0.0, variance + s * error)), float) for s in (-1, 1))
    return values, np.hypot(own, np.abs(high - low) / 2)


def against(a, b, truth_a, truth_b, layer):
    """Curves a against b, which may be of another scene: (how many times the passes of b for the same relative error,
    how many times its passes and seconds for it at equal passes), each (value, standard error). For equal error the
    logarithms of the errors are taken as parallel lines, as both slopes are alike."""
    seeds = min(a.seeds, b.seeds)

    def numbers(chosen, scale):
        late = a.late()
        lines = [
            c.log_mse(layer, chosen, scale * truth.variance[layer]) - 2 * np.log(truth.level[layer])
            for c, truth in ((a, truth_a), (b, truth_b))
        ]
        gap = np.mean((lines[0] - lines[1])[-COMPARED_ROWS:])
        slope = np.mean([statistics.line(np.log(a.passes[late]), one[late]) for one in lines])
        cost = np.log(a.processor_s[chosen].sum() / b.processor_s[chosen].sum())
        wall = np.log(a.wall_s[chosen].sum() / b.wall_s[chosen].sum())
        return [gap / -slope if slope < 0 else np.nan, gap + cost, gap + wall, cost]

    uncertain = [t.variance_error[layer] / t.variance[layer] for t in (truth_a, truth_b) if t.variance[layer] > 0]
    error = max(uncertain, default=0.0)
    values, errors = with_truth(numbers, seeds, 1.0, error)
    ratios = np.exp(values)
    return list(zip(ratios, ratios * errors))


def efficiency(plain, other, truth, layer):
    """1/(MSE x time) beside that of plain, passes of plain for equal error beside its own, processor time a pass
    beside plain's: name -> value, name_error."""
    (passes, passes_e), (eff, eff_e), (wall, wall_e), (cost, cost_e) = against(plain, other, truth, truth, layer)
    return {
        "efficiency": eff,
        "efficiency_error": eff_e,
        "efficiency_by_wall": wall,
        "efficiency_by_wall_error": wall_e,
        "passes_ratio": passes,
        "passes_ratio_error": passes_e,
        "time_ratio": 1 / cost,
        "time_ratio_error": cost_e / cost**2,
    }


def curve(curves, truth, layer):
    """Relative RMSE by passes and seconds, and its slope."""
    late = curves.late()

    def numbers(chosen, variance):
        mse = curves.log_mse(layer, chosen, variance)
        slope = statistics.line(np.log(curves.passes[late]), 0.5 * mse[late])
        return np.append(np.exp(0.5 * mse) / truth.level[layer], slope)

    values, errors = with_truth(numbers, curves.seeds, truth.variance[layer], truth.variance_error[layer])
    return {
        "passes": curves.passes.tolist(),
        "processor_s": curves.seconds.tolist(),
        "relative_rmse": values[:-1].tolist(),
        "relative_rmse_error": errors[:-1].tolist(),
        "slope": values[-1],
        "slope_error": errors[-1],
    }


def bias(plain, other, truth):
    """Whether a sampler and plain have the same mean at equal passes, where the kernel's bias is that of both. Per
    layer, from the differences of the pictures seed by seed, two tests (statistics.zero_mean): of X, Y, Z of the whole
    picture, each over its mean, and of means over blocks of 8 x 8 pixels, less the whole picture's share and over the
    root of the block's light, as noise is. bias_sigma: the least probability of all of them, given how many there
    are, as deviations of a normal variable; below 3 in 99.7 % of all measurements of a sampler without bias."""
    tests, layers, seeds = [], {}, min(plain.seeds, other.seeds)
    for layer in truth.layers:
        image = truth.images[layer]
        level = np.maximum(image.mean(axis=(0, 1)), 1e-3 * truth.level[layer])
        differences = [other.images[s][layer] - plain.images[s][layer] for s in range(seeds)]
        whole = np.array([d.mean(axis=(0, 1)) for d in differences]) / level
        light = np.maximum(pictures.blocks(image), 0) / level
        local = np.array([pictures.blocks(d) / level - w * light for d, w in zip(differences, whole)])
        local /= np.sqrt(light + 0.01)
        found = statistics.zero_mean(whole), statistics.zero_mean(local.reshape(seeds, -1))
        tests += found
        layers[layer] = {
            "mean_sigma": statistics.sigmas(found[0]),
            "blocks_sigma": statistics.sigmas(found[1]),
            "mean_difference": whole.mean(axis=0).tolist(),  # X, Y, Z, relative
            "mean_difference_error": (whole.std(axis=0, ddof=1) / np.sqrt(seeds)).tolist(),
        }
    return {"bias_sigma": statistics.sigmas(statistics.least_of(tests)), "bias": layers}


NESTED = 1e-4  # of the largest value: what rounding may take below zero


def sources(curves, twice, truth, independent):
    """Shares of the mean square error by where it comes from, per layer; None where the photons of a render should be but are
    not among those of one with twice as many.

    independent: a render of the same seed with twice the photons, doubled, less the one with once: that is the picture of the
    other half. Both halves share each pass's wavelengths and camera rays and nothing else, so their covariance over seeds
    is the variance that those make, the rest that of the photons. Photons that depend on one another have no halves: the
    variance of the photons is then twice what is gone with twice as many, as if it went as one over their number. What the mean
    over the seeds is off by is the kernel."""
    found = {}
    for layer in truth.layers:
        first = np.array([image[layer].reshape(-1) for image in curves.images])
        both = np.array([pictures.xyz(result.picture())[layer].reshape(-1) for result in twice])
        other = 2 * both - first
        if independent and other.min() < -NESTED * first.max():
            return None
        target = truth.images[layer].reshape(-1)

        def parts(chosen, variance, first=first, both=both, other=other, target=target):
            a, b = first[chosen], other[chosen]
            n = len(chosen)
            if n < 2:
                return [np.nan] * 4
            if independent:
                shared = float(np.mean((a - a.mean(axis=0)) * (b - b.mean(axis=0)))) * n / (n - 1)
                total = float(np.mean(a.var(axis=0, ddof=1) + b.var(axis=0, ddof=1))) / 2
            else:
                total = float(np.mean(a.var(axis=0, ddof=1)))
                shared = 2 * float(np.mean(both[chosen].var(axis=0, ddof=1))) - total
            kernel = statistics.own_square(a - target) - variance
            mse = total + kernel
            return [shared / mse, (total - shared) / mse, kernel / mse, mse]

        values, errors = with_truth(parts, len(first), truth.variance[layer], truth.variance_error[layer])
        names = ("wavelengths_and_camera", "photons", "kernel")
        found[layer] = {"relative_rmse": float(np.sqrt(max(values[3], 0)) / truth.level[layer])}
        for name, value, error in zip(names, values, errors):
            found[layer][name] = value
            found[layer][name + "_error"] = error
    return found


def of_scene(curves, truth):
    """All of a scene's samplers, by name, each a dict; curves by name, plain among them."""
    numbers = {}
    for name, one in curves.items():
        whole = curve(one, truth, "whole")
        entry = {
            "slope": whole["slope"],
            "slope_error": whole["slope_error"],
            "processor_s_a_pass": float(one.processor_s.mean() / one.passes[-1]),
            "wall_s_a_pass": float(one.wall_s.mean() / one.passes[-1]),
        }
        layers = {layer: curve(one, truth, layer) for layer in truth.layers}
        if name != PLAIN:
            for layer in truth.layers:
                layers[layer].update(efficiency(curves[PLAIN], one, truth, layer))
            entry.update(efficiency(curves[PLAIN], one, truth, "whole"))
            # With another kernel the means differ by its blur, which is no bias of the sampler.
            entry.update({"bias_sigma": None} if name in OTHER_KERNEL else bias(curves[PLAIN], one, truth))
        numbers[name] = {**entry, "layers": layers}
    return numbers
