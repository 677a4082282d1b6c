"""The plot."""

import math

import matplotlib

matplotlib.use("Agg")
from matplotlib import pyplot, ticker  # noqa: E402

COLOURS = ("#555555", "#2a6fbb", "#d9822b", "#3a8f4d", "#a0539b", "#b5413b", "#6b6f1d", "#1d9a9a", "#e377c2", "#8c6d31")


def colours_of(scenes):
    """Sampler -> colour, the same in all scenes."""
    names = list(dict.fromkeys(name for samplers, _ in scenes.values() for name in samplers))
    return {name: COLOURS[i % len(COLOURS)] for i, name in enumerate(names)}


def draw(scenes, file):
    """scenes: name -> samplers by name, as analysis.of_scene has them, and the truth's numbers: a row each, against
    passes and against seconds."""
    figure, grid = pyplot.subplots(
        len(scenes), 2, figsize=(11, 3.6 * len(scenes)), squeeze=False, constrained_layout=True
    )
    colours = colours_of(scenes)
    for row, (name, (samplers, truth)) in zip(grid, scenes.items()):
        for axis, across, label in zip(row, ("passes", "processor_s"), ("passes", "processor time [s]")):
            for sampler, numbers in samplers.items():
                curve = numbers["layers"]["whole"]
                errors = curve["relative_rmse_error"]
                slope = f"{sampler}: slope {numbers['slope']:.2f} ± {numbers['slope_error']:.2f}"
                axis.errorbar(
                    curve[across],
                    curve["relative_rmse"],
                    errors if any(map(math.isfinite, errors)) else None,  # none: the truth is too uncertain
                    color=colours[sampler],
                    marker="o",
                    markersize=3,
                    capsize=2,
                    linewidth=1,
                    label=slope,
                )
            axis.set_xscale("log", base=2 if across == "passes" else 10)
            axis.set_yscale("log")
            axis.set_xlabel(label)
            if across != "passes":
                axis.xaxis.set_minor_formatter(ticker.NullFormatter())
                axis.xaxis.set_major_locator(ticker.LogLocator(subs=(1, 2, 5)))
                axis.xaxis.set_major_formatter(ticker.FormatStrFormatter("%g"))
            axis.yaxis.set_minor_formatter(ticker.NullFormatter())
            axis.yaxis.set_major_locator(ticker.LogLocator(subs=(1, 2, 5)))
            axis.yaxis.set_major_formatter(ticker.FormatStrFormatter("%g"))
            axis.grid(alpha=0.3, which="both")
        for axis in row:
            axis.axhline(truth["whole"]["relative_rmse"], color="black", linestyle=":", linewidth=0.8)
        row[0].set_ylabel("relative RMSE, XYZ")
        row[0].set_title(f"{name} (dotted: error of the truth, taken off)", fontsize="medium")
        row[0].legend(fontsize=8)
    figure.savefig(file, dpi=110)
    pyplot.close(figure)
