"""Figure 20: photon power tables on and off, at equal time."""

from figures_lib import figure, figure_error, figure_masks, measure, page
from figures_lib.figure import job

KEYS = ("fig20",)

SEED = figure_error.FIRST_SEED
DIRECT = ["--no-tables"]
DIRECT_WEIGHT = 30  # expected time of a pass without tables over one with; only for the estimate of the time left


def jobs(settings):
    scene = figure_error.variant(settings, "mask", "with")
    few, many = 1, 1 + settings.probe_passes
    found = [figure_error.truth(settings, "mask", "with")]
    for word, flags, weight in (("tables", [], 1), ("direct", DIRECT, DIRECT_WEIGHT)):
        found += [job(settings, f"fig20_time_{word}_{passes}", scene, size=settings.half, passes=passes, flags=flags,
                      weight=weight) for passes in (few, many)]
    found.append(job(settings, "fig20_with", scene, size=settings.half, seed=SEED))
    found.append(job(settings, "fig20_without", scene, size=settings.half, seed=SEED, flags=DIRECT,
                     passes=lambda results: equal_time_passes(settings, results),
                     expected_passes=max(1, settings.passes // DIRECT_WEIGHT), weight=DIRECT_WEIGHT,
                     exposure=figure.exposure_of("fig20_with")))
    found.append(job(settings, "fig20_same_passes", scene, size=settings.half, seed=SEED,
                     passes=lambda results: equal_time_passes(settings, results),
                     expected_passes=max(1, settings.passes // DIRECT_WEIGHT), exposure=figure.exposure_of("fig20_with")))
    return found


def seconds_per_pass(settings, results, word):
    """Processor time [s]: set-up is the same in both renders, so it is not in their difference."""
    few, many = (results[f"fig20_time_{word}_{passes}"].processor_s for passes in (1, 1 + settings.probe_passes))
    return max(many - few, 1e-6) / settings.probe_passes


def equal_time_passes(settings, results):
    """Passes without tables in the time of settings.passes with them; at least one, and at most as many, since short
    passes are timed badly."""
    with_tables, direct = (seconds_per_pass(settings, results, word) for word in ("tables", "direct"))
    return min(max(1, round(settings.passes * with_tables / direct)), settings.passes)


def report(run):
    truth = run.results["truth_mask_with"].picture().rgb
    errors = {word: measure.rmse(run.results[f"fig20_{word}"].picture().rgb, truth)
              for word in ("with", "without", "same_passes")}
    seconds = {word: seconds_per_pass(run.settings, run.results, word) for word in ("tables", "direct")}
    passes = run.results["fig20_without"].stats["passes"]
    numbers = {"passes_with": run.settings.passes, "passes_without": passes,
               "passes_ratio": seconds["direct"] / seconds["tables"],
               "rmse_with_cd_m2": errors["with"], "rmse_without_cd_m2": errors["without"],
               "rmse_with_after_passes_without_cd_m2": errors["same_passes"],
               "processor_s_per_pass_with": seconds["tables"], "processor_s_per_pass_without": seconds["direct"]}
    return [page.Section(
        "fig20", "Figure 20: tables on and off at equal time",
        "In the time of 1024 passes with tables there are 32 passes without: every photon integrates equations 3 to 5 itself.",
        f"In the processor time of {run.settings.passes} passes with tables there are {passes} without "
        f"({seconds['direct'] / seconds['tables']:.1f} times the time per pass). RMSE {errors['with']:.3g} cd/m² with and "
        f"{errors['without']:.3g} without; with tables after as few passes {errors['same_passes']:.3g}.",
        verdict(run.settings, passes, errors),
        [[run.picture("fig20_with", f"{run.settings.passes} passes with tables"),
          run.picture("fig20_without", f"{passes} passes without, the same time"),
          run.picture("fig20_same_passes", f"{passes} passes with tables")]], numbers)]


def verdict(settings, passes, errors):
    same = abs(errors["without"] / errors["same_passes"] - 1) < 0.1
    words = "The same direction: equal time gives fewer passes without tables, and more error. " \
        if passes < settings.passes and errors["without"] > errors["with"] else \
        "At these settings the tables gain little. "
    return words + f"Of 1024 passes the paper's 32 are one in 32; here it is one in {settings.passes / passes:.0f}. " + \
        ("For equal passes both give the same error, as both are the same model." if same else
         "For equal passes the errors differ: the direct integration draws other random numbers.")
