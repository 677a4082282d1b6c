"""Figures 8, 9 and 10: the photon power tables, and the spectra that go into them."""

import csv
import json
import pathlib
import subprocess
import tempfile

import numpy as np

from figures_lib import figure, page, scenes
from figures_lib.figure import GREEN, RED, TABLES

KEYS = ("fig8", "fig9", "fig10")

SPECTRA = {
    "lamps/blacklight_blue_model.csv": ("power",),
    "fluorophores/qdot545_model.csv": ("excitation", "emission"),
    "fluorophores/qdot585_model.csv": ("excitation", "emission"),
    "fluorophores/qdot655_model.csv": ("excitation", "emission"),
}
COLOURS = {"qdot545": GREEN, "qdot585": "#d9a400", "qdot655": RED}


def jobs(settings):
    return []


def report(run):
    return [tables(run), spectra(run), media(run)]


def read_csv(name):
    """Columns of a CSV of tables/ by name, and the lines of its header."""
    with open(TABLES / name, encoding="utf-8") as file:
        lines = file.read().splitlines()
    header = [line.lstrip("# ") for line in lines if line.startswith("#")]
    rows = list(csv.reader(line for line in lines if not line.startswith("#")))
    values = np.array(rows[1:], float)
    return {column: values[:, k] for k, column in enumerate(rows[0])}, header


def power_tables(stokes):
    """Component -> (axes by name, values [r, (theta,) lambda]) of the prisms' marble, as stokes writes them."""
    found = {}
    with tempfile.TemporaryDirectory() as folder:
        subprocess.run(
            [str(stokes), "tables", str(scenes.SCENES / "prisms.json"), "-o", folder],
            check=True,
            stdout=subprocess.DEVNULL,
        )
        for file in sorted(pathlib.Path(folder).glob("*.json")):
            table = json.loads(file.read_text(encoding="utf-8"))
            axes = {axis["name"]: np.array(axis["values"]) for axis in table["axes"]}
            shape = [len(axis["values"]) for axis in table["axes"]]
            found[table["component"]] = axes, np.array(table["values"]).reshape(shape)
    return found


def tables(run):
    found = power_tables(run.stokes)
    drawing, (left, right) = figure.axes(2)
    numbers = {}
    for axis, scale in ((left, "linear"), (right, "log")):
        for component, letter, colour in (
            ("fluorescence", "F", GREEN),
            ("single", "S", "#4477aa"),
            ("multiple", "M", "#aa7744"),
        ):
            axes, values = found[component]
            mean = values.mean(axis=-1)
            curves = [(None, mean)]
            if mean.ndim == 2:
                curves = [(angle, mean[:, int(np.argmin(np.abs(axes["theta"] - angle)))]) for angle in (30, 60)]
            for angle, curve in curves:
                name = letter if angle is None else f"{letter}, θ = {angle}°"
                axis.plot(axes["r"], curve, color=colour, linestyle="--" if angle == 60 else "-", label=name)
                key = letter if angle is None else f"{letter}_{angle}"
                one = int(np.argmin(np.abs(axes["r"] - 1)))
                numbers[key] = {
                    "at_0_mm": curve[0],
                    "at_1_mm": curve[one],
                    "at_5_mm": float(np.interp(5, axes["r"], curve)),
                    "falls_monotonically": bool(np.all(np.diff(curve) < 0)),
                }
        axis.set_yscale(scale)
        axis.set_xlabel("r [mm]")
        axis.set_xlim(0, 9.9)
    left.set_ylabel("mean over the wavelengths (F: mm, S: 1, M: 1/mm$^2$)")
    left.legend()
    rise = {key: curve["at_1_mm"] / curve["at_0_mm"] for key, curve in numbers.items()}
    return page.Section(
        "fig8",
        "Figure 8: photon power tables",
        "Mean over all wavelengths of each table against r: F and S at θ = 30° and 60°, and M.",
        f"At r = 1 mm: F {numbers['F_30']['at_1_mm']:.3f} and {numbers['F_60']['at_1_mm']:.3f}, S "
        f"{numbers['S_30']['at_1_mm']:.4f} and {numbers['S_60']['at_1_mm']:.4f} at 30° and 60°, M "
        f"{numbers['M']['at_1_mm']:.4f}. From 0 to 1 mm F changes by the factor {rise['F_30']:.2f} at 30° and "
        f"{rise['F_60']:.2f} at 60°.",
        "The tables are the integrals of the paper's equations 3 to 5, within 1e-4"
        " (tests/physics/test_power_tables.cpp), so the curves are those the printed equations give. The three have"
        " different units, as printed.",
        [[run.plot("fig8", drawing, "Mean over 300 to 795 nm of the tables of marble with half its scattering.")]],
        numbers,
    )


def spectra(run):
    drawing, axes = figure.axes(2)
    numbers, sources = {}, []
    for name, columns in SPECTRA.items():
        values, header = read_csv(name)
        stem = name.split("/")[1].removesuffix(".csv").removesuffix("_model")
        sources.append(f"{stem}: {header[1].removeprefix('STATUS: ').split(' - ')[0].split(' (')[0]}")
        for column in columns:
            axis = axes[0] if column == "power" else axes[1]
            colour = COLOURS.get(stem, figure.VIOLET)
            axis.plot(
                values["wavelength_nm"],
                values[column],
                "--" if column == "excitation" else "-",
                color=colour,
                label=f"{stem} {column}",
            )
            if column == "emission":
                numbers[stem] = _peak(values["wavelength_nm"], values[column])
            elif column == "power":
                band = (values["wavelength_nm"] >= 400) & (values["wavelength_nm"] <= 500)
                numbers["lamp"] = {
                    "peak_nm": float(values["wavelength_nm"][np.argmax(values[column])]),
                    "share_400_to_500_nm": float(values[column][band].sum() / values[column].sum()),
                }
    for axis in axes:
        axis.set_xlabel("wavelength [nm]")
        axis.set_xlim(300, 780)
        axis.legend(fontsize=8)
    axes[0].set_ylabel("relative to the maximum")
    dots = ", ".join(
        f"{name}: {numbers[name]['peak_nm']:.0f} nm, {numbers[name]['fwhm_nm']:.1f} nm wide" for name in COLOURS
    )
    return page.Section(
        "fig9",
        "Figure 9: lamp and quantum dots",
        "Spectra of the black light and of Qdot 545, 585 and 655.",
        f"Emission peaks and widths: {dots}. Of the lamp's power {100 * numbers['lamp']['share_400_to_500_nm']:.1f} %"
        " lies at 400 to 500 nm.",
        "The same kind, not the same data: the paper's curves are the manufacturer's; ours are closed forms fitted to"
        " such curves (rms error at most 0.01 of the maximum), and a model of a black light with its violet tail. "
        + "; ".join(sources)
        + ". See tables/README.md.",
        [[run.plot("fig9", drawing, "Left the lamp, right excitation (dashed) and emission.")]],
        numbers,
    )


def _peak(wavelengths, values):
    above = wavelengths[values >= 0.5 * values.max()]
    return {"peak_nm": float(wavelengths[np.argmax(values)]), "fwhm_nm": float(above[-1] - above[0] + 1)}


def media(run):
    values, _ = read_csv("media/marble_spectral_model.csv")
    drawing, (left, right) = figure.axes(2)
    half = 0.5 * values["ss_lin"]
    left.plot(values["wavelength_nm"], half, color="#4477aa")
    left.set_ylabel("scattering [1/mm]")
    right.plot(values["wavelength_nm"], values["sa_lin"], color="#aa4455")
    right.set_ylabel("absorption [1/mm]")
    for axis in (left, right):
        axis.set_xlabel("wavelength [nm]")
        axis.set_xlim(300, 780)
        axis.set_ylim(bottom=0)
    at = {
        f"{w}_nm": {
            "sigma_s_per_mm": float(np.interp(w, values["wavelength_nm"], half)),
            "sigma_a_per_mm": float(np.interp(w, values["wavelength_nm"], values["sa_lin"])),
        }
        for w in (365, 464, 549, 611)
    }
    return page.Section(
        "fig10",
        "Figure 10: marble",
        "Scattering and absorption coefficients against wavelength.",
        f"At 549 nm: scattering {at['549_nm']['sigma_s_per_mm']:.3f}, absorption {at['549_nm']['sigma_a_per_mm']:.4f}"
        " per mm.",
        "The marble of Jensen et al. 2001 with half its scattering, as the paper's Table 2 has it. Its three RGB"
        " values stand at 611.4, 549.1 and 464.3 nm, straight lines between them and constants beyond: the"
        " publication gives no wavelengths, so these are assumed.",
        [[run.plot("fig10", drawing, "Coefficients of the marble of all scenes (scattering halved).")]],
        at,
    )
