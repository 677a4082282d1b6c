"""Figure 20: photon power tables on and off, at equal time."""

from figures_lib import figure, figure_error, figure_masks, measure, page
from figures_lib.figure import job

KEYS = ("fig20",)

SEED = figure_error.FIRST_SEED
DIRECT = ["--no-tables"]


def jobs(settings):
    scene = figure_error.variant(settings, "mask", "with")

    def render(name, **changes):
        return job(settings, name, scene, size=settings.half_square, seed=SEED, **changes)

    return [
        figure_error.truth(settings, "mask", "with"),
        render("fig20_one_pass_with", passes=1),
        render("fig20_one_pass_without", passes=1, flags=DIRECT),
        render("fig20_with"),
        render("fig20_same_passes", flags=DIRECT, exposure=figure.exposure_of("fig20_with")),
        render(
            "fig20_without",
            flags=DIRECT,
            exposure=figure.exposure_of("fig20_with"),
            passes=lambda results: equal_time_passes(settings, results),
            expected_passes=settings.passes,
        ),
    ]


def seconds_per_pass(settings, results, many, one):
    """Processor time [s] of a pass: set-up is the same in both renders, so it is not in their difference."""
    return max(results[many].processor_s - results[one].processor_s, 1e-6) / max(settings.passes - 1, 1)


def pass_seconds(settings, results):
    return (
        seconds_per_pass(settings, results, "fig20_with", "fig20_one_pass_with"),
        seconds_per_pass(settings, results, "fig20_same_passes", "fig20_one_pass_without"),
    )


def equal_time_passes(settings, results):
    """Passes without tables in the time of settings.passes with them: at least one, and at most twice as many, since a
    few short passes are timed badly."""
    with_tables, direct = pass_seconds(settings, results)
    return min(max(1, round(settings.passes * with_tables / direct)), 2 * settings.passes)


def report(run):
    truth = run.results["truth_mask_with"].picture().rgb
    errors = {
        word: measure.rmse(run.results[f"fig20_{word}"].picture().rgb, truth)
        for word in ("with", "without", "same_passes")
    }
    grain = {
        word: measure.rmse_of_shape(run.results[f"fig20_{word}"].picture().rgb, truth)
        for word in ("with", "without")
    }
    with_tables, direct = pass_seconds(run.settings, run.results)
    passes = run.results["fig20_without"].stats["passes"]
    numbers = {
        "passes_with": run.settings.passes,
        "passes_without": passes,
        "time_of_a_pass_without_over_with": direct / with_tables,
        "rmse_with_cd_m2": errors["with"],
        "rmse_without_cd_m2": errors["without"],
        "rmse_of_grain_with_cd_m2": grain["with"],
        "rmse_of_grain_without_cd_m2": grain["without"],
        "rmse_without_after_passes_with_cd_m2": errors["same_passes"],
        "processor_s_per_pass_with": with_tables,
        "processor_s_per_pass_without": direct,
    }
    return [
        page.Section(
            "fig20",
            "Figure 20: tables on and off at equal time",
            "In the time of 1024 passes with tables there are 32 passes without: every photon integrates equations 3"
            " to 5 itself.",
            f"In the processor time of {run.settings.passes} passes with tables there are {passes} without: a pass"
            f" takes {direct / with_tables:.2f} times the time (set-up not counted). RMSE {errors['with']:.3g} cd/m²"
            f" with and {errors['without']:.3g} without tables in equal time, {errors['same_passes']:.3g} without"
            f" after {run.settings.passes} passes. These are mostly the draw of wavelengths; the grain alone (brightness"
            f" and hue of the whole picture fitted) {grain['with']:.3g} and {grain['without']:.3g}.",
            verdict(run.settings, passes),
            [
                [
                    run.picture("fig20_with", f"{run.settings.passes} passes with tables"),
                    run.picture("fig20_without", f"{passes} passes without, the same time"),
                ]
            ],
            numbers,
        )
    ]


def verdict(settings, passes):
    share = passes / settings.passes
    if share < 1 / 10:
        return f"Same: tables give {1 / share:.0f} times the passes."
    return (
        f"Not the same, a finding: without tables there are {share:.2f} times the passes, not 1/32. Integrals at an"
        " event take sixteen nodes or fewer for all sixteen wavelengths at once here, and the distance is drawn"
        " without tabulating anything, by rejection; this costs about what looking tables up costs, beside rays and"
        " density estimates. What the paper's program integrates with, and how finely, is not stated."
    )
