"""Reads what write_h5md_sample wrote with h5py, and checks each number against its formula."""
import os
import signal
import subprocess
import sys
import tempfile

import h5py
import numpy as np

NEEDLES, FRAMES, SAMPLES, EVENTS = 5, 7, 3, 5000


def same(dataset, expected):
    expected = np.asarray(expected)
    assert dataset.shape == expected.shape, (dataset.name, dataset.shape, expected.shape)
    assert np.array_equal(dataset[...], expected), (dataset.name, dataset[...], expected)


def text(value):
    return value.decode() if isinstance(value, bytes) else value


def check_metadata(file):
    h5md = file["h5md"]
    assert list(h5md.attrs["version"]) == [1, 1]
    assert text(h5md["creator"].attrs["name"]) == "needlework"
    assert text(h5md["creator"].attrs["version"]).count(".") == 2
    assert text(h5md["author"].attrs["name"])
    box = file["particles/needles/box"]
    assert box.attrs["dimension"] == 3 and box.attrs["dimension"].shape == ()
    assert [text(b) for b in box.attrs["boundary"]] == ["periodic"] * 3
    # H5MD 1.1 has these strings of fixed length.
    for where, name in [("h5md/author", "name"), ("h5md/creator", "name"),
                        ("h5md/creator", "version"), ("particles/needles/box", "boundary")]:
        kind = h5py.check_string_dtype(file[where].attrs.get_id(name).dtype)
        assert kind is not None and kind.length, (where, name)
    found = []
    file.visititems(lambda name, item: found.extend(
        (name, key) for key in item.attrs if key == "unit"))
    assert not found, found


def check_parameters(file):
    parameters = {name: item[()] for name, item in file["parameters"].items()}
    assert text(parameters["scene"]) == "[needles]\ncount = 5\n# é\n"
    assert text(parameters["title"]) == "sample"
    assert text(parameters["isa"]) == "avx2"
    assert text(parameters["accuracy"]) == "rigorous"
    assert text(parameters["version"]) == text(file["h5md/creator"].attrs["version"])
    assert parameters["seed"] == 18446744073709551615
    assert parameters["threads"] == 2
    assert parameters["epoch_length"] == 0.5
    assert (parameters["k"], parameters["epsilon"], parameters["beta"]) == (4.5, 0.75, -0.5)


def check_element(element, rows, values, shared):
    same(element["value"], values)
    same(element["step"], 100 * np.arange(rows))
    same(element["time"], 0.5 * np.arange(rows))
    # Hard links to one and the same dataset.
    assert element["step"] == shared["step"] and element["time"] == shared["time"], element.name


def check_frames(file):
    group = file["particles/needles"]
    f, i = np.meshgrid(np.arange(FRAMES), np.arange(NEEDLES), indexing="ij")
    zero = 0 * i
    even = i % 2 == 0
    expected = {
        "position": [0.5 * i, f + 0.25, i / 8],
        "velocity": [-i, 0.5 * f, 2 * i],
        "orientation": [zero, even, ~even],
        "angular_velocity": [i + f, zero, zero],
        "image": [i, -f, zero],
        "box/edges": None,
    }
    for name, columns in expected.items():
        values = np.array([np.diag([8, 9, 10])] * FRAMES) if columns is None else np.stack(
            columns, axis=-1)
        check_element(group[name], FRAMES, values, group["position"])
    assert group["position/value"].dtype == np.float64
    assert group["image/value"].dtype.kind == "i"
    same(group["id"], 10 + np.arange(NEEDLES))
    same(group["mass"], np.ones(NEEDLES))


def check_totals(group, rows, shared):
    row = np.arange(rows)
    expected = {
        "t_tr": 1 / (1 + row),
        "t_rot": 2 / (1 + row),
        "energy": 3 / (1 + row),
        "momentum": np.stack([0.25 * row, -row, 0 * row], axis=-1),
        "collisions": 100 * row,
        "tc_collisions": row,
    }
    assert set(group) - {"step", "time"} == set(expected)
    for name, values in expected.items():
        check_element(group[name], rows, values, shared)


def check_events(file):
    e = np.arange(EVENTS)
    events = file["events"]
    same(events["time"], 0.125 * e)
    same(events["epoch"], e // 4)
    same(events["offset"], 0.125 * (e % 4))
    same(events["pair"], np.stack([10 + e % 3, 13 + e % 2], axis=-1))
    same(events["arms"], np.stack([0.5 / (1 + e), np.full(EVENTS, -0.25)], axis=-1))
    same(events["normal_velocity"], -e)
    same(events["tc"], e % 5 == 0)
    same(events["shift"], np.stack([e % 3 - 1, 0 * e, 0 * e + 1], axis=-1))
    same(events["impulse"], np.stack([e, 0 * e + 0.5, 0 * e], axis=-1))
    assert len(events) == 9


def check_all(file):
    check_metadata(file)
    check_parameters(file)
    check_frames(file)
    check_totals(file["observables"], FRAMES, file["particles/needles/position"])
    check_totals(file["series"], SAMPLES, file["series"])
    check_events(file)


def check_files(folder, names):
    for name in names:
        for swmr in [False, True]:
            with h5py.File(os.path.join(folder, name), "r", swmr=swmr) as file:
                check_all(file)


def check_refused(path):
    try:
        h5py.File(path, "r+")
    except OSError:
        return
    raise AssertionError(f"{path}: opened for writing, although another program writes it")


def main(writer, _program):
    with tempfile.TemporaryDirectory() as folder:
        with subprocess.Popen([writer, folder, "stop"]) as process:
            _, status = os.waitpid(process.pid, os.WUNTRACED)
            assert os.WIFSTOPPED(status), status
            # While they are written.
            check_files(folder, ["killed.h5", "continued.h5"])
            for name in ["killed.h5", "continued.h5"]:
                check_refused(os.path.join(folder, name))
            process.send_signal(signal.SIGCONT)
            process.wait(3600)
        assert process.returncode == -signal.SIGKILL, process.returncode
        check_files(folder, ["sample.h5", "killed.h5", "continued.h5"])
        with h5py.File(os.path.join(folder, "empty.h5"), "r") as file:
            assert file["particles/needles/position/value"].shape == (1, 0, 3)
            assert file["events/pair"].shape == (0, 2)
            assert file["particles/needles/id"][...].shape == (0,)
        with h5py.File(os.path.join(folder, "header.h5"), "r") as file:
            assert file["particles/needles/position/value"].shape == (0, NEEDLES, 3)
            assert file["particles/needles/position/time"].shape == (0,)


if __name__ == "__main__":
    main(*sys.argv[1:])
