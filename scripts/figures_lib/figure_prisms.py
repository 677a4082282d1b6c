"""Figure 1: six prisms with a sphere, a dragon and a bunny; another view; the light moved."""

from figures_lib import page, scenes
from figures_lib.figure import MODELS, base, exposure_of, job

KEYS = ("fig1",)

VIEWS = {
    "a": {},
    "b": {"camera.position_mm": [265, 150, 250], "camera.target_mm": [-4, 36, 0]},
    "c": {"lights.black light.position_mm": [150, 390, 150], "lights.black light.direction": [-0.42, -1, -0.42]},
}


def jobs(settings):
    prisms = base("prisms", settings)
    return [
        job(
            settings,
            f"fig1{view}_{model}",
            scenes.change(prisms, changes),
            transport=model,
            exposure=None if view == "a" else exposure_of(f"fig1a_{model}"),
        )
        for model in MODELS
        for view, changes in VIEWS.items()
    ]


def report(run):
    words = {"a": "(a)", "b": "(b) another view", "c": "(c) the light moved"}
    rows = [[run.picture(f"fig1{view}_{model}", f"{words[view]}, {model}") for view in VIEWS] for model in MODELS]
    numbers = {}
    for model in MODELS:
        whole = run.results[f"fig1a_{model}"].picture()
        light = {name: float(whole.luminance(name).mean()) for name in whole.layers if name}
        numbers[model] = {
            "mean_luminance_cd_m2": float(whole.luminance().mean()),
            "share_of_luminance": {name: value / sum(light.values()) for name, value in light.items()},
            "exposure_ev": run.results[f"fig1a_{model}"].exposure_ev,
        }
    share = {model: numbers[model]["share_of_luminance"]["fluorescence"] for model in MODELS}
    return [
        page.Section(
            "fig1",
            "Figure 1: prisms with quantum dots",
            "Six prisms of marble with Qdot 545, 585 and 655 under black light: the front row with subsurface"
            " scattering, the row behind with fluorescence of the surface alone; white figures on them are lit by the"
            " prisms.",
            f"{run.settings.passes} passes. Fluorescence directly seen is {100 * share['paper']:.0f} % of the"
            f" luminance ({100 * share['conserving']:.0f} % in model conserving); the rest is light from diffuse"
            " surfaces and scattered black light.",
            "The same kind of picture: saturated prisms, whose colours reach the white figures and the floor. The"
            " positions, the lamp's spectrum and the white figures' places are ours, as the paper does not give them."
            " Model conserving gives the translucent row more scattered violet light, which the paper's tables lose;"
            " each model has its own exposure.",
            rows,
            numbers,
        )
    ]
