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
        return figure_masks.scene(settings, "cat", "545", True) if word == "with" else \
            figure_masks.adjusted(settings, "cat", "545")
    prisms = base("prisms", settings)
    changes = {}
    for row in ("front", "back"):
        for colour, dot in zip(("green", "yellow", "red"), DOTS):
            material = "subsurface" if word == "with" else "surface"
            changes[f"shapes.{row} {colour} prism.material"] = f"qdot{dot} {material}"
    return scenes.change(prisms, changes)


def truth(settings, name, word):
    return job(settings, f"truth_{name}_{word}", variant(settings, name, word), passes=settings.truth_passes,
               size=settings.half, seed=TRUTH_SEED)


def curve(settings, name, word, seed):
    reference = f"truth_{name}_{word}"
    return job(settings, f"curve_{name}_{word}_{seed}", variant(settings, name, word), size=settings.half, seed=seed,
               flags=lambda results: ["--rmse-against", results[reference].exr, "--csv", "CURVE"],
               references=lambda results: [results[reference].exr])


def seeds(settings):
    return range(FIRST_SEED, FIRST_SEED + settings.curve_seeds)


def jobs(settings):
    found = figure_masks.probes(settings)
    for name in SCENES:
        for word in WITH:
            found.append(truth(settings, name, word))
            found += [curve(settings, name, word, seed) for seed in seeds(settings)]
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
        scale = np.mean(run.results[f"truth_{name}_{word}"].picture().luminance())
        numbers[word] = {
            "slope": slope, "slope_error": error, "slope_as_measured": measure.slope(passes[late], errors[late])[0],
            "truth_error_cd_m2": truth_error, "mean_luminance_cd_m2": float(scale), "passes": passes.tolist(),
            "rmse_cd_m2": errors.tolist(), "rmse_corrected_cd_m2": corrected.tolist()}
        fitted[word] = passes[late], corrected[late]
        axis.loglog(passes, corrected, "o-", color=COLOURS[word], markersize=4,
                    label=f"{words}: slope {slope:.2f} ± {error:.2f}")
        for errors_of_seed in own:
            axis.loglog(passes, errors_of_seed, ":", color=COLOURS[word], linewidth=0.8)
    ratio = measure.pass_ratio(*fitted["with"], *fitted["without"])
    numbers["pass_ratio"], numbers["pass_ratio_range"] = (ratio[0], ratio[1:]) if ratio else (None, None)
    relative = [(passes, errors / numbers[word]["mean_luminance_cd_m2"]) for word, (passes, errors) in fitted.items()]
    ratio = measure.pass_ratio(*relative[0], *relative[1])
    numbers["pass_ratio_of_relative_errors"] = ratio[0] if ratio else None
    axis.set_xlabel("passes")
    axis.set_title(SCENES[name])
    axis.legend(fontsize=8)
    return numbers


def report(run):
    drawing, axes = figure.axes(2)
    found = {name: measured(run, name, axis) for name, axis in zip(SCENES, axes)}
    axes[0].set_ylabel("RMSE [cd/m$^2$]")
    mask = found["mask"]
    numbers = {"pass_ratio": mask["pass_ratio"], "slope_with": mask["with"]["slope"],
               "slope_without": mask["without"]["slope"], "slope_with_error": mask["with"]["slope_error"],
               "slope_without_error": mask["without"]["slope_error"], "truth_passes": run.settings.truth_passes, **found}
    reduction = "" if run.settings.truth_passes >= 10000 else " (the paper: 10,000)"
    return [page.Section(
        "fig14", "Figure 14: error against passes",
        "RMSE falls on a straight line in log-log; for equal error scattering takes about 3.5 times as many passes.",
        f"Mask: slopes {_slope(mask, 'with')} with and {_slope(mask, 'without')} without scattering, passes for equal error "
        f"{_ratio(mask)}. Prisms: {_slope(found['prisms'], 'with')}, {_slope(found['prisms'], 'without')}, {_ratio(found['prisms'])}. "
        f"Root mean square over {run.settings.curve_seeds} seeds, over pixels and X, Y, Z, against truths of "
        f"{run.settings.truth_passes} passes{reduction} and another seed. The truth errs too: as both errors follow one power "
        "law and are independent, its part is fitted and taken off (points); dotted as measured. Pictures of half the width.",
        verdict(mask, found["prisms"]),
        [[run.plot("fig14", drawing, "Error over all pixels. Light without scattering adjusted to equal brightness (mask).")]],
        numbers)]


def _slope(numbers, word):
    return f"{numbers[word]['slope']:.2f} ± {numbers[word]['slope_error']:.2f}"


def _ratio(numbers):
    if numbers["pass_ratio"] is None:
        return "not comparable: the curves share no error"
    return f"{numbers['pass_ratio']:.2f} times with scattering ({numbers['pass_ratio_range'][0]:.2f} to " \
           f"{numbers['pass_ratio_range'][1]:.2f})"


def verdict(mask, prisms):
    return "The curves are straight. See the numbers."
