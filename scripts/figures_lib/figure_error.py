"""Figure 14: RMSE against passes, with and without subsurface scattering."""

import csv

import numpy as np

from figures_lib import figure, figure_masks, measure, page, scenes
from figures_lib.figure import base, job

KEYS = ("fig14",)

PAPER_RATIO = 3.5
SCENES = {"mask": "the cat's mask, Qdot 545", "prisms": "the six prisms"}
WITH = {"with": "with scattering, c = 0.5", "without": "without scattering, c = 1.0"}
COLOURS = {"with": "#2a6fbb", "without": "#d9822b"}
DOTS = ("545", "585", "655")
TRUTH_SEED, FIRST_SEED = 1001, 1
FIRST_PASSES = 4  # where fits begin: the first few passes see few wavelengths


def variant(settings, name, word):
    """The scene, with or without scattering in all of it."""
    if name == "mask":
        return (
            figure_masks.scene(settings, "cat", "545", True)
            if word == "with"
            else figure_masks.adjusted(settings, "cat", "545")
        )
    prisms = base("prisms", settings)
    changes = {}
    for row in ("front", "back"):
        for colour, dot in zip(("green", "yellow", "red"), DOTS):
            material = "subsurface" if word == "with" else "surface"
            changes[f"shapes.{row} {colour} prism.material"] = f"qdot{dot} {material}"
    return scenes.change(prisms, changes)


def size(settings, name):
    """The mask's picture is square."""
    return settings.half_square if name == "mask" else settings.half


def truth(settings, name, word):
    return job(
        settings,
        f"truth_{name}_{word}",
        variant(settings, name, word),
        passes=settings.truth_passes,
        size=size(settings, name),
        seed=TRUTH_SEED,
    )


def curve(settings, name, word, seed):
    reference = f"truth_{name}_{word}"
    return job(
        settings,
        f"curve_{name}_{word}_{seed}",
        variant(settings, name, word),
        size=size(settings, name),
        seed=seed,
        flags=lambda results: ["--rmse-against", results[reference].exr, "--csv", "CURVE"],
        references=lambda results: [results[reference].exr],
    )


def grain_passes(settings):
    """Where the picture itself is kept, for its grain."""
    return [max(1, settings.passes // part) for part in (16, 8, 4, 2, 1)]


def at(settings, word, passes):
    return job(
        settings,
        f"fig14_{word}_{passes}",
        variant(settings, "mask", word),
        size=settings.half_square,
        passes=passes,
        seed=FIRST_SEED,
    )


def seeds(settings):
    return range(FIRST_SEED, FIRST_SEED + settings.curve_seeds)


def jobs(settings):
    found = figure_masks.probes(settings)
    for name in SCENES:
        for word in WITH:
            found.append(truth(settings, name, word))
            found += [curve(settings, name, word, seed) for seed in seeds(settings)]
    for word in WITH:
        found += [at(settings, word, passes) for passes in grain_passes(settings)]
    return found


def read_curve(result):
    """Passes and RMSE [cd/m^2] of the whole light, from --csv."""
    with open(result.curve, encoding="utf-8", newline="") as file:
        rows = list(csv.DictReader(file))
    return (np.array([float(row["passes"]) for row in rows]), np.array([float(row["rmse_whole"]) for row in rows]))


def mean_curve(run, name, word):
    """Passes and root mean square over the seeds of the RMSE, and the seeds' own."""
    curves = [read_curve(run.results[f"curve_{name}_{word}_{seed}"]) for seed in seeds(run.settings)]
    own = np.array([errors for _, errors in curves])
    return curves[0][0], np.sqrt(np.mean(own**2, axis=0)), own


def measured(run, name, axis):
    """The numbers of a scene; draws its curves."""
    settings, numbers, fitted = run.settings, {}, {}
    for word, words in WITH.items():
        passes, errors, own = mean_curve(run, name, word)
        corrected, truth_error = measure.true_error(passes, errors, settings.truth_passes)
        late = passes >= min(FIRST_PASSES, passes[-1] / 4)
        slope, error = measure.slope(passes[late], corrected[late])
        # Relative to the mean luminance: as if the light had been adjusted to equal brightness.
        scale = float(np.mean(run.results[f"truth_{name}_{word}"].picture().luminance()))
        errors, own = errors / scale, own / scale
        corrected, truth_error = corrected / scale, truth_error / scale
        numbers[word] = {
            "slope": slope,
            "slope_error": error,
            "slope_as_measured": measure.slope(passes[late], errors[late])[0],
            "truth_relative_rmse": truth_error,
            "mean_luminance_cd_m2": scale,
            "passes": passes.tolist(),
            "relative_rmse": errors.tolist(),
            "relative_rmse_corrected": corrected.tolist(),
        }
        fitted[word] = passes[late], corrected[late]
        axis.loglog(
            passes,
            corrected,
            "o-",
            color=COLOURS[word],
            markersize=4,
            label=f"{words}: slope {slope:.2f} ± {error:.2f}",
        )
        for errors_of_seed in own:
            axis.loglog(passes, errors_of_seed, ":", color=COLOURS[word], linewidth=0.8)
    numbers["pass_ratio"], numbers["pass_ratio_error"] = measure.pass_ratio(
        fitted["with"][0], fitted["with"][1], fitted["without"][1]
    )
    axis.set_xlabel("passes")
    axis.set_title(SCENES[name])
    axis.legend(fontsize=8)
    return numbers


def grain(run, axis):
    """The error that is left of the mask's when brightness and hue of the whole picture are fitted; draws it."""
    passes, numbers = grain_passes(run.settings), {}
    for word, words in WITH.items():
        truth_rgb = run.results[f"truth_mask_{word}"].picture().rgb
        errors = [measure.rmse_of_shape(run.results[f"fig14_{word}_{n}"].picture().rgb, truth_rgb) for n in passes]
        errors, _ = measure.true_error(passes, errors, run.settings.truth_passes)
        errors = errors / truth_rgb.dot(measure.XYZ_OF_RGB[1]).mean()
        slope, error = measure.slope(passes, errors)
        numbers[word] = {"slope": slope, "slope_error": error, "passes": passes, "relative_rmse": list(errors)}
        axis.loglog(
            passes,
            errors,
            "s--",
            color=COLOURS[word],
            markersize=4,
            markerfacecolor="none",
            label=f"grain alone: slope {slope:.2f} ± {error:.2f}",
        )
    axis.legend(fontsize=8)
    numbers["pass_ratio"], numbers["pass_ratio_error"] = measure.pass_ratio(
        passes, numbers["with"]["relative_rmse"], numbers["without"]["relative_rmse"]
    )
    return numbers


def report(run):
    drawing, axes = figure.axes(2)
    found = {name: measured(run, name, axis) for name, axis in zip(SCENES, axes)}
    axes[0].set_ylabel("RMSE / mean luminance")
    mask, prisms = found["mask"], found["prisms"]
    mask["grain"] = grain(run, axes[0])
    numbers = {
        "pass_ratio": mask["pass_ratio"],
        "pass_ratio_error": mask["pass_ratio_error"],
        "slope_with": mask["with"]["slope"],
        "slope_without": mask["without"]["slope"],
        "slope_with_error": mask["with"]["slope_error"],
        "slope_without_error": mask["without"]["slope_error"],
        "truth_passes": run.settings.truth_passes,
        **found,
    }
    reduction = "" if run.settings.truth_passes >= 10000 else " (the paper: 10,000)"
    return [
        page.Section(
            "fig14",
            "Figure 14: error against passes",
            "RMSE falls on a straight line in log-log; for equal error scattering takes about 3.5 times as many"
            " passes.",
            f"Mask: slopes {_slope(mask, 'with')} with and {_slope(mask, 'without')} without scattering, passes for"
            f" equal error {_ratio(mask)} times with scattering. Prisms: {_slope(prisms, 'with')} and"
            f" {_slope(prisms, 'without')}, {_ratio(prisms)} times. Root mean square over {run.settings.curve_seeds}"
            f" seeds, over pixels and X, Y, Z, against truths of {run.settings.truth_passes} passes{reduction} and"
            " another seed. The truth errs too: as both errors follow one power law and are independent, its part is"
            " fitted and taken off (points); dotted are the seeds as measured. Errors are relative to the mean"
            " luminance, so that both are compared at equal brightness. Pictures of half the width.",
            verdict(mask, prisms),
            [[run.plot("fig14", drawing, "Error over all pixels, relative to the mean luminance.")]],
            numbers,
        )
    ]


def _slope(numbers, word):
    return f"{numbers[word]['slope']:.2f} ± {numbers[word]['slope_error']:.2f}"


def _ratio(numbers):
    return f"{numbers['pass_ratio']:.2f} ± {numbers['pass_ratio_error']:.2f}"


def verdict(mask, prisms):
    ratio = mask["pass_ratio"]
    grain_words = (
        " Two things err: the grain of the photons, which scattering makes coarser, and the brightness and hue of the"
        " whole picture, as 16 of 481 wavelengths are drawn in each pass for all pixels at once, with scattering or"
        " without. With the whole picture's brightness and hue fitted to the truth, the mask's grain alone needs"
        f" {_ratio(mask['grain'])} times the passes. How much the grain counts depends on the photons of a pass,"
        " which the paper does not state: more of them hide the cost of scattering behind that of the wavelengths."
    )
    if abs(ratio / PAPER_RATIO - 1) < 0.3:
        return f"Same: scattering takes {ratio:.1f} times as many passes." + grain_words
    both = f"{ratio:.2f} times (mask) and {prisms['pass_ratio']:.2f} times (prisms), not about {PAPER_RATIO}."
    if max(ratio, prisms["pass_ratio"]) > 1.1:
        return f"The same direction, smaller factors: {both}" + grain_words
    return f"Not the same: {both}" + grain_words
