"""Reads what `needlework export` made of write_h5md_sample's files: VTKHDF with h5py dataset by
dataset, and with VTK, where there is one, as ParaView does; collections of .vtu files with VTK."""
import os
import signal
import subprocess
import sys
import tempfile
import xml.etree.ElementTree

import h5py
import numpy as np

try:
    from vtkmodules.util.numpy_support import vtk_to_numpy
    from vtkmodules.vtkIOHDF import vtkHDFReader
    from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridReader
except ImportError:
    vtkHDFReader = None

VTK_LINE = 3


def expected(needles, frame=6):
    """A frame of the sample, by default the last."""
    i = np.arange(needles)
    one = np.ones(needles)
    u = np.stack([0 * one, i % 2 == 0, i % 2 == 1], axis=-1)
    r = np.stack([0.5 * i, (frame + 0.25) * one, i / 8], axis=-1)
    return {
        "points": np.stack([r - u / 2, r + u / 2], axis=1).reshape(2 * needles, 3),
        "id": 10 + i,
        "orientation": u,
        "velocity": np.stack([-1.0 * i, 0.5 * frame * one, 2.0 * i], axis=-1),
        "angular_velocity": np.stack([i + frame, 0 * one, 0 * one], axis=-1),
    }


def same(found, wanted, name):
    assert found.shape == wanted.shape, (name, found.shape, wanted.shape)
    assert np.array_equal(found, wanted), (name, found, wanted)


def check_structure(path, needles, values):
    with h5py.File(path, "r") as file:
        root = file["VTKHDF"]
        assert list(root.attrs["Version"]) == [1, 0]
        # The format has the type as an ASCII string of fixed length.
        kind = h5py.check_string_dtype(root.attrs.get_id("Type").dtype)
        assert kind.encoding == "ascii" and kind.length == len("UnstructuredGrid")
        assert root.attrs["Type"] == b"UnstructuredGrid"
        for name, count in [("NumberOfPoints", 2 * needles), ("NumberOfCells", needles),
                            ("NumberOfConnectivityIds", 2 * needles)]:
            assert root[name].dtype == np.int64
            same(root[name][...], np.array([count]), name)
        same(root["Points"][...], values["points"], "Points")
        same(root["Connectivity"][...], np.arange(2 * needles), "Connectivity")
        same(root["Offsets"][...], 2 * np.arange(needles + 1), "Offsets")
        same(root["Types"][...], np.full(needles, VTK_LINE), "Types")
        assert root["Types"].dtype == np.uint8
        assert set(root["CellData"]) == set(values) - {"points"}
        for name, data in root["CellData"].items():
            same(data[...], values[name], name)


def check_with_vtk(path, needles, values):
    reader = vtkHDFReader()
    assert reader.CanReadFile(path)
    reader.SetFileName(path)
    reader.Update()
    grid = reader.GetOutputDataObject(0)
    assert grid.GetClassName() == "vtkUnstructuredGrid"
    assert grid.GetNumberOfCells() == needles
    for i in range(needles):
        points = grid.GetCell(i).GetPointIds()
        assert grid.GetCellType(i) == VTK_LINE
        assert [points.GetId(0), points.GetId(1)] == [2 * i, 2 * i + 1]
    if needles == 0:
        return
    same(vtk_to_numpy(grid.GetPoints().GetData()), values["points"], "points")
    for name in set(values) - {"points"}:
        same(vtk_to_numpy(grid.GetCellData().GetArray(name)), values[name], name)


def read_grid(path):
    reader = vtkXMLUnstructuredGridReader()
    reader.SetFileName(path)
    reader.Update()
    assert reader.GetErrorCode() == 0, path
    return reader.GetOutput()


def check_grid(path, needles, values):
    grid = read_grid(path)
    assert grid.GetNumberOfCells() == needles
    assert [grid.GetCellType(i) for i in range(needles)] == needles * [VTK_LINE]
    if needles == 0:
        return
    points = vtk_to_numpy(grid.GetPoints().GetData())
    same(points, values["points"], "points")
    ends = [[grid.GetCell(i).GetPointId(end) for end in (0, 1)] for i in range(needles)]
    assert ends == [[2 * i, 2 * i + 1] for i in range(needles)]
    for name in ("velocity", "orientation", "angular_velocity"):
        same(vtk_to_numpy(grid.GetCellData().GetArray(name)), values[name], name)
    size = {"speed": values["velocity"], "spin": values["angular_velocity"]}
    wanted = {name: np.linalg.norm(vectors, axis=1) for name, vectors in size.items()}
    wanted |= {"id": values["id"], "species": np.zeros(needles)}
    assert grid.GetPointData().GetNumberOfArrays() == len(wanted)
    for name, numbers in wanted.items():
        found = vtk_to_numpy(grid.GetPointData().GetArray(name))
        assert np.allclose(found, np.repeat(numbers, 2), rtol=1e-15, atol=0), (name, found)


def check_collection(folder, name, needles, program):
    path = os.path.join(folder, name + ".pvd")
    subprocess.run([program, "export", os.path.join(folder, name + ".h5"), path], check=True,
                   timeout=3600)
    files = [(float(data.get("timestep")), data.get("part"), data.get("file"))
             for data in xml.etree.ElementTree.parse(path).getroot().iter("DataSet")]
    frames = [(time, file) for time, part, file in files if part == "0"]
    boxes = [(time, file) for time, part, file in files if part == "1"]
    assert [time for time, _ in frames] == [time for time, _ in boxes]
    assert [time for time, _ in frames] == [0.5 * frame for frame in range(len(frames))]
    for frame, (_, file) in enumerate(frames):
        check_grid(os.path.join(folder, file), needles, expected(needles, frame))
    for _, file in boxes:
        box = read_grid(os.path.join(folder, file))
        assert box.GetFieldData().GetNumberOfArrays() == 0
        assert box.GetBounds() == (0, 8, 0, 9, 0, 10) and box.GetNumberOfCells() == 12
        lengths = [box.GetCell(i).GetLength2() for i in range(12)]
        assert sorted(lengths) == 4 * [64] + 4 * [81] + 4 * [100], lengths
    return len(frames)


WALLED = """
needles = { count = 20, box = [4, 5, 6] }
walls = [{ axis = "y", side = "both" }]
until = { time = 0.1 }
"""


def check_walls(folder, program):
    """The outline of a box says along which axes it is periodic, unless along all."""
    scene, run = os.path.join(folder, "walled.toml"), os.path.join(folder, "walled.h5")
    with open(scene, "w", encoding="utf-8") as file:
        file.write(WALLED)
    subprocess.run([program, "run", scene, "--out", run, "--quiet"], check=True, timeout=3600)
    subprocess.run([program, "export", run, os.path.join(folder, "walled.pvd")], check=True,
                   timeout=3600)
    grid = read_grid(os.path.join(folder, "walled", "box-00000.vtu"))
    assert grid.GetBounds() == (0, 4, 0, 5, 0, 6)
    same(vtk_to_numpy(grid.GetFieldData().GetArray("periodic")), np.array([1, 0, 1]), "periodic")


SHEARED = """
needles = { count = 20, box = [4, 5, 6] }
shear = { rate = -0.3 }
until.time = 4
output.frames_every = 1
"""


def check_sheared(folder, program):
    """The outline of a sheared box has eight corners that are tilted, and needles within."""
    scene, run = os.path.join(folder, "sheared.toml"), os.path.join(folder, "sheared.h5")
    with open(scene, "w", encoding="utf-8") as file:
        file.write(SHEARED)
    subprocess.run([program, "run", scene, "--out", run, "--quiet"], check=True, timeout=3600)
    subprocess.run([program, "export", run, os.path.join(folder, "sheared.pvd")], check=True,
                   timeout=3600)
    with h5py.File(run) as file:
        tilts = file["particles/needles/box/edges/value"][:, 1, 0]
    tilts = tilts - 4 * (tilts >= 2)
    assert len(tilts) == 5 and min(tilts) < 0 < max(tilts), tilts
    for frame, tilt in enumerate(tilts):
        grid = read_grid(os.path.join(folder, "sheared", f"box-{frame:05}.vtu"))
        corners = {tuple(np.round(point, 9)) for point in vtk_to_numpy(grid.GetPoints().GetData())}
        assert corners == {(round(4.0 * x + tilt * y, 9), 5.0 * y, 6.0 * z) for x in (0, 1)
                           for y in (0, 1) for z in (0, 1)}, corners
        lengths = sorted(grid.GetCell(i).GetLength2() for i in range(12))
        assert np.allclose(lengths, sorted(4 * [16] + 4 * [25 + tilt**2] + 4 * [36])), lengths
        needles = read_grid(os.path.join(folder, "sheared", f"frame-{frame:05}.vtu"))
        ends = vtk_to_numpy(needles.GetPoints().GetData())
        centres = (ends[::2] + ends[1::2]) / 2
        along = centres[:, 0] - tilt * centres[:, 1] / 5
        assert np.all((along > -1e-12) & (along < 4 + 1e-12)), along


DIFFERING = """
needles.box = 9
until.time = 0.1
[[species]]
name = "a"
count = 20
length = { distribution = "lognormal", mean = 1, width = 0.3 }
diameter.aspect = 5
mass.density = 2
"""


def check_bodies_that_differ(folder, program):
    """Lines are as long as their needles, and say length, mass and radius at both ends."""
    scene, run = os.path.join(folder, "differing.toml"), os.path.join(folder, "differing.h5")
    with open(scene, "w", encoding="utf-8") as file:
        file.write(DIFFERING)
    subprocess.run([program, "run", scene, "--out", run, "--quiet"], check=True, timeout=3600)
    for name in ("differing.pvd", "differing.vtkhdf"):
        subprocess.run([program, "export", run, os.path.join(folder, name)], check=True, timeout=3600)
    with h5py.File(run) as file:
        wanted = {name: file["particles/needles"][name][:] for name in ("length", "mass")}
        wanted["radius"] = file["particles/needles/diameter"][:] / 2
    reader = vtkHDFReader()
    reader.SetFileName(os.path.join(folder, "differing.vtkhdf"))
    reader.Update()
    for grid in (read_grid(os.path.join(folder, "differing", "frame-00001.vtu")),
                 reader.GetOutputDataObject(0)):
        for name, numbers in wanted.items():
            same(vtk_to_numpy(grid.GetPointData().GetArray(name)), np.repeat(numbers, 2), name)
        ends = vtk_to_numpy(grid.GetPoints().GetData())
        lengths = np.linalg.norm(ends[1::2] - ends[::2], axis=1)
        assert np.allclose(lengths, wanted["length"], rtol=1e-13, atol=0), lengths


def main(writer, program):
    with tempfile.TemporaryDirectory() as folder:
        result = subprocess.run([writer, folder], timeout=3600)
        assert result.returncode == -signal.SIGKILL, result.returncode
        for name, needles in [("sample", 5), ("killed", 5), ("empty", 0)]:
            path = os.path.join(folder, name + ".vtkhdf")
            subprocess.run([program, "export", os.path.join(folder, name + ".h5"), path],
                           check=True, timeout=3600)
            values = expected(needles)
            check_structure(path, needles, values)
            if vtkHDFReader:
                check_with_vtk(path, needles, values)
        if vtkHDFReader:
            assert check_collection(folder, "sample", 5, program) == 7
            check_collection(folder, "empty", 0, program)
            check_walls(folder, program)
            check_sheared(folder, program)
            check_bodies_that_differ(folder, program)
    if not vtkHDFReader:
        print("read with h5py, but not with VTK: python3-vtk9 is not installed")
        sys.exit(77)  # skipped


if __name__ == "__main__":
    main(*sys.argv[1:])
