#!/usr/bin/python3
"""Draws the two pictures of the README from two runs: needles.png and cooling.png, beside this file.

    docs/pictures/draw.py [--program build/release/needlework]

needles.png shows the last frame of profiles/quickstart.toml in perspective, coloured by speed.
cooling.png shows the series of profiles/cooling-dilute.toml beside kinetic theory. The runs take
less than a minute. Needs python3-h5py and python3-matplotlib.
"""

import argparse
import json
import subprocess
import tempfile
from pathlib import Path

import h5py
import matplotlib
import numpy as np

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402
from matplotlib.collections import LineCollection  # noqa: E402
from matplotlib.ticker import NullFormatter  # noqa: E402
from PIL import Image  # noqa: E402

HERE = Path(__file__).resolve().parent
PROFILES = HERE.parents[1] / "profiles"
NIGHT = "#0b1020"
# Colours of speeds, without those that are lost on a dark ground.
SPEEDS = matplotlib.colors.ListedColormap(plt.get_cmap("plasma")(np.linspace(0.22, 1, 256)))


def run(program, scene, file):
    subprocess.run([program, "run", PROFILES / scene, "--out", file, "--quiet"], check=True)


class Camera:
    """Looks at the middle of a box from above one of its corners."""

    def __init__(self, box, distance=2.4, azimuth=0.58, height=0.42):
        self.middle = box / 2
        across = np.array([-np.sin(azimuth), np.cos(azimuth), 0])
        outwards = np.array([np.cos(height) * np.cos(azimuth), np.cos(height) * np.sin(azimuth),
                             np.sin(height)])
        self.axes = np.array([across, np.cross(outwards, across), outwards])
        self.distance = distance * box.max()

    def project(self, points):
        """Points in the picture, and how much larger than in the middle of the box they look."""
        seen = (points - self.middle) @ self.axes.T
        scale = self.distance / (self.distance - seen[..., 2])
        return seen[..., :2] * scale[..., None], scale


def save(figure, picture):
    """With 256 colours, which make the file a third as large."""
    figure.savefig(picture, dpi=130, facecolor=figure.get_facecolor())
    Image.open(picture).convert("RGB").quantize(256, kmeans=4).save(picture, optimize=True)


def box_edges(box):
    corners = np.array(np.meshgrid([0, 1], [0, 1], [0, 1])).T.reshape(-1, 3)
    return np.array([[a, b] for a in corners for b in corners
                     if np.sum(b - a) == 1 and np.abs(b - a).sum() == 1]) * box


def draw_needles(file, picture):
    with h5py.File(file) as f:
        needles = f["particles/needles"]
        box = np.diagonal(needles["box/edges/value"][-1])
        centre = needles["position/value"][-1]
        director = needles["orientation/value"][-1]
        speed = np.linalg.norm(needles["velocity/value"][-1], axis=1)
    speed /= np.sqrt(np.mean(speed**2))

    camera = Camera(box)
    ends, scale = camera.project(np.stack([centre - director / 2, centre + director / 2], axis=1))
    depth = scale.mean(axis=1)
    order = np.argsort(depth)
    near = (depth - depth.min()) / (depth.max() - depth.min())
    colours = SPEEDS(np.clip(speed / 2, 0, 1))
    fog = np.array(matplotlib.colors.to_rgba(NIGHT))
    share = (0.4 + 0.6 * near)[:, None]
    colours = share * colours + (1 - share) * fog

    figure = plt.figure(figsize=(6.4, 6.4), facecolor=NIGHT)
    axes = figure.add_axes([0, 0.07, 1, 0.93])
    edges, _ = camera.project(box_edges(box))
    axes.add_collection(LineCollection(edges, colors="#4a5680", linewidths=0.8))
    axes.add_collection(LineCollection(ends[order], colors=colours[order], capstyle="round",
                                       linewidths=0.9 + 2.0 * near[order]))
    axes.autoscale()
    axes.set_aspect("equal")
    axes.axis("off")

    bar_axes = figure.add_axes([0.28, 0.055, 0.44, 0.014])
    bar = figure.colorbar(plt.cm.ScalarMappable(plt.Normalize(0, 2), SPEEDS), cax=bar_axes,
                          orientation="horizontal", ticks=[0, 1, 2])
    bar.outline.set_visible(False)
    bar.ax.set_xticklabels(["0", "1", "2"], color="white", fontsize=11)
    bar.ax.tick_params(length=0, pad=4)
    figure.text(0.5, 0.085, "speed / root mean square speed", color="white", fontsize=11,
                ha="center")
    save(figure, picture)


def theory(program, tau):
    """Temperatures of the scene at these times, by kinetic theory."""
    flags = [part for t in tau for part in ("--tau", repr(float(t)))]
    printed = subprocess.run([program, "theory", "--epsilon", "0.8", "--k", "6", "--t-rot0", "0",
                              "--json", *flags], check=True, capture_output=True, text=True).stdout
    curve = json.loads(printed)
    return [np.array(curve[name]) for name in ("energy", "t_tr", "t_rot")]


def draw_cooling(program, file, picture):
    with h5py.File(file) as f:
        time = f["series/energy/time"][1:]
        energy, t_tr, t_rot = (f["series"][name]["value"][:] for name in ("energy", "t_tr", "t_rot"))
        box = np.diagonal(f["particles/needles/box/edges/value"][0])
        count = len(f["particles/needles/id"])
    tau = 2 / 3 * np.sqrt(np.pi) * count / np.prod(box) * time
    energy_theory, t_tr_theory, t_rot_theory = theory(program, tau)
    start = energy[0]
    energy, ratio = energy[1:], t_tr[1:] / t_rot[1:]

    plt.rcParams["font.size"] = 11
    figure, (top, middle, bottom) = plt.subplots(
        3, 1, figsize=(6.4, 6.4), sharex=True, gridspec_kw={"height_ratios": [3.2, 1, 1]})
    measured = {"color": "#d1495b", "marker": "o", "markersize": 3.6, "linestyle": "none"}
    line = {"color": "#1d3557", "linewidth": 1.6}
    top.loglog(time, energy_theory / start, **line, label="kinetic theory")
    top.loglog(time, energy / start, **measured, label="10000 needles")
    top.set_ylabel("E / E(0)")
    top.set_ylim(3e-12, 4)
    top.annotate("E ~ 1 / time²", (2e4, 2.5e-6), xytext=(1.2e5, 2e-4),
                 arrowprops={"arrowstyle": "-", "color": "#888888"}, color="#444444")
    top.legend(frameon=False, loc="lower left")
    middle.axhline(1, **line)
    middle.semilogx(time, energy / energy_theory, **measured)
    middle.set_ylim(0.9, 1.1)
    middle.set_ylabel("E / theory")
    bottom.loglog(time, t_tr_theory / t_rot_theory, **line)
    bottom.loglog(time, ratio, **measured)
    bottom.set_ylim(0.8, 30)
    bottom.set_yticks([1, 3, 10, 30], labels=["1", "3", "10", "30"])
    bottom.yaxis.set_minor_formatter(NullFormatter())
    bottom.set_ylabel(r"$T_{\rm tr}\ /\ T_{\rm rot}$")
    bottom.set_xlabel(r"time  [$L\sqrt{m/T}$]")
    for axes in (top, middle, bottom):
        axes.grid(color="#e4e4e4", linewidth=0.6)
        axes.set_axisbelow(True)
        axes.spines[["top", "right"]].set_visible(False)
        axes.set_xlim(0.1, 3e7)
    figure.align_ylabels()
    figure.tight_layout(h_pad=0.6)
    save(figure, picture)


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--program", default="build/release/needlework", help="the program to run")
    program = parser.parse_args().program
    with tempfile.TemporaryDirectory() as folder:
        quickstart, cooling = Path(folder, "quickstart.h5"), Path(folder, "cooling.h5")
        run(program, "quickstart.toml", quickstart)
        draw_needles(quickstart, HERE / "needles.png")
        run(program, "cooling-dilute.toml", cooling)
        draw_cooling(program, cooling, HERE / "cooling.png")


if __name__ == "__main__":
    main()
