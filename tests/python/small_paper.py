"""The runs of the paper with a handful of needles each, which take some seconds in all."""

import os
from pathlib import Path

from needlework.reproduce import PAPER

PROGRAM = os.environ.get("NEEDLEWORK_PROGRAM", "needlework")

FEW = {"needles.count": 40}
COLD = {"needles.box": 3, "until.energy_ratio": 1e-2}
DENSE = {**FEW, "needles.box": 2.2, "output.grid": 2, "until.collisions_per_needle": 30}
DILUTE = {**FEW, "needles.box": 3, "output.grid": 2, "until.energy_ratio": 1e-7}
TC = {"collisions.tc_relative": [1e-2, 1e-4]}


LOW = {"needles.box": [4, 9.5]}
LOW_TC = {"collisions.tc_relative": 1e-3, "output.series_per_decade": 20}
LOW_RATIO = {**LOW, **LOW_TC, "needles.k": [2, 6], "collisions.epsilon": [0.8]}
RELAXING = {**FEW, "needles.k": [2, 6], "until.time": 1000, "until.collisions_per_needle": 13,
            "output.series_every": 0.5, "output.observables": [["velocity_moments"]]}
SLIDING = {**FEW, "needles.box": 4, "collisions.epsilon": [0.8, 0.5], "until.energy_ratio": 1e-2}
SHEAR = {"needles.count": 16, "needles.box": 2.5, "until.time": 8}
OBSTACLES = {"species.moving.count": 30, "species.still.count": 100, "until.time": 5,
             "output.series_every": 0.05}
ROUGH_SPHERES = {"species.spheres.count": 40, "needles.box": 16.1,
                 "until.collisions_per_needle": 160}
GROWTH = {"driving.growth.rate": [0.1], "output.series_per_decade": 500}
LIQUID = {**FEW, "until.time": 3, "output.series_every": 0.02}


def box(edge):
    return "dense", {"needles.count": 16, "needles.box": edge, "output.grid": 2,
                     "until.collisions_per_needle": 605}


CHANNEL = {"needles.box": [[3, 3, 6]], "output.grid": 6, "until.time": 40,
           "output.series_every": 1}
"""Of flows between thermal walls."""

GRIDS = {
    "dilute": ("dilute", DILUTE),
    "dilute-tc": ("dilute", {**DILUTE, **TC}),
    "elastic": ("elastic", {**FEW, "needles.box": 3, "output.grid": 2,
                            "until.collisions_per_needle": 20}),
    "ratio": ("ratio", {**FEW, "collisions.epsilon": [0.8], "needles.k": [2, 4.3607], **COLD}),
    "rough": ("rough", {**FEW, "collisions.epsilon": [0.7, 0.9], "collisions.beta": [-0.5, 0.5],
                        **COLD}),
    "rough-spheres": ("rough-spheres", {**ROUGH_SPHERES, "collisions.epsilon": [0.7, 0.9],
                                        "collisions.beta": [-0.5, 0.5]}),
    "rough-spheres-smooth": ("rough-spheres", {**ROUGH_SPHERES, "collisions.beta": -0.9,
                                               "species.spheres.t_rot": 50}),
    "relaxation": ("relaxation", {**FEW, "needles.box": [3, 4], "until.time": 20}),
    "dense": ("dense", {**DENSE, "needles.k": [6, 2], "initial.t_rot": [1, 0]}),
    "dense-tc": ("dense", {**DENSE, **TC}),
    "dilute-sliding": ("dilute-sliding", {**FEW, "needles.box": 3, "until.energy_ratio": 1e-7}),
    "dense-sliding": ("dense-sliding", DENSE),
    "sliding": ("sliding", {**SLIDING, "collisions.sliding": "true",
                            "collisions.elastic_strikes": "[true, false]"}),
    "sliding-rule": ("sliding", {**SLIDING, "collisions.tc_relative": [1e-2, 1e-3]}),
    "box-small": box(2.1),
    "box-middle": box(2.4),
    "box-large": box(2.3),
    "dense-large": box(2.5),
    "kicked": ("kicked", {**FEW, "needles.box": 4, "needles.k": [2, 6],
                          "collisions.epsilon": [0.9], "until.time": 10}),
    "vibrated": ("vibrated", {"needles.count": 20, "needles.box": [[3, 3, 6]],
                              "collisions.epsilon": [0.9, 0.8],
                              "walls.z-low.motion.frequency": [1.5, 3.0], "until.time": 30}),
    "vibrated-small": ("vibrated", {"needles.count": 20, "needles.box": [[3, 3, 6]],
                                    "collisions.epsilon": [0.8],
                                    "walls.z-low.motion.amplitude": 0.01, "until.time": 10}),
    "shear-thin": ("shear", {**SHEAR, "needles.box": 5.4288, "collisions.epsilon": [0.9]}),
    "shear": ("shear", {**SHEAR, "collisions.epsilon": [0.9, 0.7]}),
    "shear-dense": ("shear", {**SHEAR, "needles.count": 40, "collisions.epsilon": [0.9]}),
    "shear-large": ("shear", {**SHEAR, "needles.count": 50, "needles.box": 3}),
    "shear-rods": ("shear", {**SHEAR, "needles.diameter": 0.2}),
    "shear-spheres": ("shear-spheres", {"until.time": 2}),
    "piston": ("piston", {"needles.count": 20, "needles.box": [[2.1, 2.1, 4]],
                          "walls.z-high.motion.stop_at": 2,
                          "walls.z-high.motion.velocity": [-1, -0.03], "until.time": 80,
                          "output.series_every": 20}),
    "piston-out": ("piston", {"needles.count": 20, "needles.box": [[2.1, 2.1, 2]],
                              "walls.z-high.motion.stop_at": 4,
                              "walls.z-high.motion.velocity": 1, "until.time": 5}),
    "piston-spheres": ("piston-spheres", {"species.spheres.count": 20, "needles.box": [[4, 4, 8]],
                                          "walls.z-high.motion.stop_at": 5,
                                          "walls.z-high.motion.velocity": -1, "until.time": 5}),
    "couette-needles": ("couette-needles", {**CHANNEL, "needles.count": 30}),
    "couette-rods": ("couette-rods", {**CHANNEL, "species.rods.count": 20}),
    "couette-spheres": ("couette-spheres", {**CHANNEL, "species.spheres.count": 20}),
    "channel-needles": ("channel-needles", {**CHANNEL, "needles.count": 30}),
    "channel-rods": ("channel-rods", {**CHANNEL, "species.rods.count": 20}),
    "channel-spheres": ("channel-spheres", {**CHANNEL, "species.spheres.count": 20}),
    "walls": ("walls", {"needles.count": 30, "needles.box": [[3, 3, 2], [3, 3, 2.5]],
                        "collisions.epsilon": [1, 0.8], "until.energy_ratio": 0.05,
                        "until.time": 100}),
    "sedimentation": ("sedimentation", {"needles.count": 30, "needles.box": [[4, 4, 4]],
                                        "until.time": 30,
                                        "output.frames": [[*range(10, 31)]]}),
    "settling": ("settling", {"needles.count": 30, "needles.box": [[4, 4, 20]],
                              "collisions.epsilon": [0.8], "until.time": 100}),
    "rods": ("rods", {**FEW, "needles.box": 6, "needles.diameter": [1, 0.2],
                      "collisions.epsilon": [0.8], "until.energy_ratio": 0.03}),
    "rods-dense": ("rods", {**FEW, "needles.box": 2.5, "needles.diameter": 0.2,
                            "collisions.epsilon": [0.8], "until.energy_ratio": 0.03}),
    "rods-flow": ("rods-flow", {**FEW, "needles.box": 2.5, "output.grid": 2,
                                "until.collisions_per_needle": 605}),
    "nematic": ("nematic", {"needles.count": 144, "needles.box": [2.5478, 2.4421],
                            "initial.packing": ["lattice", "crossed"],
                            "until.collisions_per_needle": 30}),
    "low-relaxation": ("relaxation", {**RELAXING, "needles.box": 4}),
    "low-relaxation-thin": ("relaxation", {**RELAXING, "needles.box": 9.5}),
    "low-dilute": ("dilute", {**FEW, **LOW, **LOW_TC, "until.energy_ratio": 1e-2}),
    "low-ratio": ("ratio", {**FEW, **LOW_RATIO, "until.energy_ratio": 1e-2}),
    "liquid-thin": ("liquid", {**LIQUID, "needles.box": [3.4199518934, 2.9240177382]}),
    "liquid": ("liquid", {**LIQUID, "needles.count": 100, "needles.box": [2.3, 2.1]}),
    "liquid-dense": ("liquid", {**LIQUID, "needles.count": 410, "needles.box": 2.04}),
    "liquid-small": ("liquid", {**LIQUID, "needles.count": 90, "needles.box": 2.2}),
    "liquid-large": ("liquid", {**LIQUID, "needles.count": 110, "needles.box": 2.4}),
    "obstacles-thin": ("obstacles", {**OBSTACLES, "needles.box": [4, 3]}),
    "obstacles": ("obstacles", {**OBSTACLES, "needles.box": [2.5, 2.3]}),
    "obstacles-dense": ("obstacles", {**OBSTACLES, "needles.box": 2.1}),
    "obstacles-large": ("obstacles", {**OBSTACLES, "species.still.count": 150,
                                      "needles.box": 2.862}),
    "obstacles-spheres": ("obstacles-spheres", {**OBSTACLES, "needles.box": [4, 3, 2.5]}),
    "obstacles-beads": ("obstacles-spheres", {**OBSTACLES, "needles.box": [4, 2.5],
                                              "species.still.diameter": 0.04}),
    "obstacles-beads-dense": ("obstacles-spheres", {**OBSTACLES, "needles.box": 2.1,
                                                    "species.still.diameter": 0.04}),
    "obstacles-points": ("obstacles-points", {**OBSTACLES, "needles.box": [5, 4]}),
    "packings": ("packings", {"species.spheres.count": 30, "needles.box": 4, **GROWTH}),
    "packings-fast": ("packings", {"species.spheres.count": 30, "needles.box": 4, **GROWTH,
                                   "driving.growth.rate": [0.3]}),
    "packings-slow": ("packings", {"species.spheres.count": 30, "needles.box": 4, **GROWTH,
                                   "driving.growth.rate": [0.05]}),
    "packings-mixture": ("packings-mixture", {"species.small.count": 15, "species.large.count": 15,
                                              "needles.box": 5, **GROWTH}),
    "packings-rods": ("packings-rods", {"species.rods.count": 40, "needles.box": 9,
                                        "species.rods.length": [0.2, 0.45, 1], **GROWTH}),
}
"""Scene and parameters of each set of runs; seeds are 1, 2 and 3."""

EQUATIONS = {
    "boltzmann-relaxation": ("relaxation", "single encounters", 2000,
                             "first = 0.25, last = 8.75, step = 0.25", {"needles.k": [2, 6]}),
    "boltzmann-dilute": ("dilute", "single encounters", 300,
                         "first = 0.1, last = 100, per_decade = 10", {**FEW, **LOW, **LOW_TC}),
    "boltzmann-ratio": ("ratio", "single encounters", 200,
                        "first = 10, last = 200, per_decade = 10", {**FEW, **LOW_RATIO}),
    "boltzmann-encounters": ("elastic", "encounters", 4000, "first = 1, last = 1, step = 1",
                             {"needles.k": [2, 6]}),
}
"""Scene, pairs, needles, times and parameters of each set of simulations of the Boltzmann equation;
seeds are the same."""


def write(folder):
    """Writes scenes, small grids and the claims into a folder, as PaperRuns and --paper take it."""
    paper = Path(folder)
    (paper / "full").mkdir(parents=True)
    for file in PAPER.glob("*.toml"):
        (paper / file.name).write_text(file.read_text())
    for name, (scene, parameters) in GRIDS.items():
        lines = [f'scene = "../{scene}.toml"', "seeds = [1, 2, 3]", "[parameters]"]
        write_grid(paper, name, lines, parameters)
    for name, (scene, pairs, needles, times, parameters) in EQUATIONS.items():
        lines = [f'scene = "../{scene}.toml"', "seeds = [1, 2, 3]", "[boltzmann]",
                 f"pairs = {pairs.split()}", f"needles = {needles}", f"tau = {{ {times} }}",
                 "[parameters]"]
        write_grid(paper, name, lines, parameters)
    return paper


def write_grid(paper, name, lines, parameters):
    """The lines and the parameters below them as the file of a set."""
    lines = lines + [f'"{key}" = {value}' for key, value in parameters.items()]
    (paper / "full" / f"{name}.toml").write_text("\n".join(lines) + "\n")
