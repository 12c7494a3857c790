"""Checkpoints as lists of fields, for tests that change them and repair their checksum."""

import struct

TYPES = {"u8": "<B", "i8": "<b", "i16": "<h", "i32": "<i", "u32": "<I", "u64": "<Q", "i64": "<q",
         "f64": "<d"}


def _crc_table():
    table = []
    for n in range(256):
        for _ in range(8):
            n = n >> 1 ^ (0xc96c5795d7870f42 if n & 1 else 0)
        table.append(n)
    return table


TABLE = _crc_table()


def checksum(data):
    """The cyclic redundancy check of ECMA-182, reflected."""
    crc = 2**64 - 1
    for byte in data:
        crc = TABLE[(crc ^ byte) & 255] ^ crc >> 8
    return crc ^ 2**64 - 1


def mark_of(file):
    """Its first line, which names the version of the program."""
    mark = file[:file.index(b"\n") + 1]
    assert mark.startswith(b"needlework checkpoint 11 of "), mark
    return mark


def sealed(mark, content):
    """A file of this content, with the right size and checksum."""
    return mark + struct.pack("<QQ", len(content), checksum(content)) + content


def content_of(file):
    begin = len(mark_of(file))
    size, crc = struct.unpack_from("<QQ", file, begin)
    content = file[begin + 16:]
    assert len(content) == size and checksum(content) == crc
    return content


class Fields:
    """The places and types of all numbers and lengths in the content of a checkpoint.

    Of a scene with the t_c rule or, if `sliding`, with needles that slide on each other.
    """

    def __init__(self, content, sliding):
        self.content, self.at, self.found, self.sliding = content, 0, [], sliding
        self.scene()
        self.one("drawn", "u8")
        self.totals("initial")
        self.simulation()
        for name in ("frames", "samples", "events", "velocities_set", "data", "data_bytes"):
            self.one(f"position.{name}", "u64")
        self.observation()
        self.optional("velocities_set", self.f64)
        self.sequence("data", self.user_data)
        self.one("has_failure", "u8")
        assert self.at == len(content), "the checkpoint has another layout than this test knows"

    def one(self, name, kind):
        value, = struct.unpack_from(TYPES[kind], self.content, self.at)
        self.found.append((name, kind, self.at))
        self.at += struct.calcsize(TYPES[kind])
        return value

    def several(self, name, kind, count):
        return [self.one(name, kind) for _ in range(count)]

    def text(self, name):
        size = self.one(f"{name}.size", "u64")
        self.found.append((name, "text", (self.at, size)))
        self.at += size
        return self.content[self.at - size:self.at]

    def sequence(self, name, each):
        for _ in range(self.one(f"{name}.size", "u64")):
            each(name)

    def optional(self, name, each):
        if self.one(f"{name}.given", "u8"):
            each(name)

    def f64(self, name):
        return self.one(name, "f64")

    def totals(self, name):
        self.several(name, "f64", 7)
        self.several(f"{name}.counts", "u64", 2)

    def scene(self):
        self.text("title")

        def species(name):
            self.text(f"{name}.name")
            self.one(f"{name}.count", "u64")
            self.several(name, "f64", 6)
            self.optional(f"{name}.inertia", self.f64)
            for number in ("length", "diameter", "mass", "k", "inertia"):
                self.optional(f"{name}.drawn.{number}", distribution)
            for number in ("density", "aspect"):
                self.optional(f"{name}.drawn.{number}", self.f64)
            for flag in ("drawn.homogeneous", "fixed", "overlap"):
                self.one(f"{name}.{flag}", "u8")
            self.optional(f"{name}.sizes", lambda name: self.several(name, "f64", 26))

        def distribution(name):
            self.one(f"{name}.shape", "u8")
            for number in ("mean", "width", "least", "greatest", "exponent"):
                self.optional(f"{name}.{number}", self.f64)

        def place(name):
            self.text(name)
            self.text(name)

        def pair(name):
            self.text(f"{name}.between")
            self.text(f"{name}.between")
            self.optional(f"{name}.epsilon", self.f64)
            self.optional(f"{name}.beta", self.f64)
            self.one(f"{name}.meet", "u8")

        self.sequence("species", species)
        self.sequence("pairs", pair)
        self.one("needles.count", "u64")
        self.several("needles.box", "f64", 3)
        self.several("needles.k", "f64", 2)
        self.one("needles.seed", "u64")
        self.several("initial.t", "f64", 2)
        self.text("initial.file")
        self.text("initial.packing")
        self.several("collisions", "f64", 2)
        for name in ("tc", "tc_relative"):
            self.optional(f"collisions.{name}", self.f64)
        self.one("collisions.sliding", "u8")
        self.f64("collisions.sliding_below")
        self.one("collisions.elastic_strikes", "u8")

        def three(name):
            self.several(name, "f64", 3)

        def growth(name):
            self.f64(f"{name}.rate")
            for end in ("until_packing", "until_pressure", "cool_every"):
                self.optional(f"{name}.{end}", self.f64)

        def wall(name):
            self.text(f"{name}.axis")
            self.text(f"{name}.side")
            self.f64(f"{name}.epsilon")
            self.optional(f"{name}.temperature", self.f64)
            self.optional(f"{name}.motion", three)

        self.sequence("walls", wall)
        self.several("forces.gravity", "f64", 3)
        self.optional("shear", lambda name: self.several(name, "f64", 2))
        self.optional("driving.kicks", three)
        self.optional("driving.andersen", lambda name: self.several(name, "f64", 2))
        self.optional("driving.growth", growth)
        for name in ("search", "queue", "accuracy"):
            self.text(f"engine.{name}")
        for name in ("isolation", "escalation", "filter"):
            self.optional(f"engine.{name}", self.text)
        for name in ("root_tolerance", "sampling_step"):
            self.optional(f"engine.{name}", self.f64)
        self.optional("engine.threads", lambda name: self.one(name, "i32"))
        self.text("engine.team")
        self.text("engine.isa")
        for name in ("cell_side", "capsule_radius"):
            self.optional(f"engine.{name}", self.f64)
        self.text("engine.storage")
        for name in ("time", "collisions_per_needle", "energy_ratio", "wall_s"):
            self.optional(f"until.{name}", self.f64)
        self.text("output.file")
        self.f64("output.series_per_decade")
        self.optional("output.series_every", self.f64)
        self.sequence("output.frame_times", self.f64)
        self.optional("output.frames_per_decade", self.f64)
        self.optional("output.frames_every", self.f64)
        self.sequence("output.observables", self.text)
        self.optional("output.grid", lambda name: self.several(name, "i32", 3))
        self.optional("output.size_classes", lambda name: self.one(name, "i32"))
        self.one("output.events", "u8")
        self.f64("output.checkpoint_every")
        self.text("text")
        self.sequence("places", place)

    def time(self, name):
        self.one(f"{name}.epoch", "i64")
        self.one(f"{name}.offset", "f64")

    def touch(self, name):
        self.several(name, "u32", 2)
        self.several(f"{name}.shift", "i16", 3)
        self.one(f"{name}.side", "i8")
        self.one(f"{name}.collided", "u8")
        self.f64(f"{name}.gap")

    def simulation(self):
        end = self.one("simulation.size", "u64") + self.at
        size = self.one("physics.size", "u64")
        self.several("box", "f64", 3)
        self.several("physics", "f64", size - 3)
        count = self.one("count", "u64")
        self.f64("epoch_length")
        for _ in range(count):
            self.one("id", "u32")
            self.several("image", "i32", 3)
            self.time("record.time")
            for part in "rvuw":
                self.several(f"record.{part}", "f64", 3)
            self.one("record.serial", "u32")
            self.one("record.species", "u8")
            self.sequence("touch", self.touch)
            if self.sliding:
                self.one("meetings.last", "u32")
                self.time("meetings.with_last")
                self.time("meetings.others")
                self.one("meetings.in_crowd", "u32")
            else:
                self.time("last_collision")
        self.time("now")
        self.time("window_end")
        for name in ("mean_free_time", "initial_energy", "energy_at_window", "motion_at_window"):
            self.f64(name)
        self.several("quanta_at_window", "u64", 2)
        self.f64("drift_of_windows")
        for name in ("collisions", "tc_collisions", "quanta", "quanta", "hash", "hash"):
            self.one(f"tally.{name}", "u64")
        self.several("counters", "u64", 24)
        self.time("instant")
        self.one("at_instant", "u64")
        if self.sliding:
            for name in ("entered", "by_force", "by_tip", "by_strike", "crowded", "steps"):
                self.one(f"sliding.{name}", "u64")
            self.several("sliding.time", "u64", 68)  # digits of an exact sum
        self.several("share_of_pairs", "f64", 2)
        self.several("share_of_pairs.quanta", "u64", 2)
        self.several("shares_of_kicks_and_callers", "f64", 4)
        self.time("temperature.noted_at")
        self.several("temperature", "f64", 2)
        assert self.at == end

    def user_data(self, name):
        self.text(f"{name}.name")
        self.one(f"{name}.json", "u8")
        self.text(f"{name}.bytes")

    def vector(self, name):
        self.several(name, "f64", 3)

    def reference(self, name):
        self.one(f"{name}.sample", "u64")
        self.f64(f"{name}.time")
        self.sequence(f"{name}.position", self.vector)
        self.sequence(f"{name}.orientation", self.vector)

    def schedule(self, name):
        self.several(name, "f64", 3)
        self.sequence(f"{name}.times", self.f64)
        self.one(f"{name}.position", "u64")
        self.f64(f"{name}.next")

    def chain(self, name):
        self.several(name, "u32", 2)
        self.one(f"{name}.length", "u64")

    def observation(self):
        """Of a drawn gas with the observables displacement and collision_statistics."""
        end = self.one("observation.size", "u64") + self.at
        self.several("theory", "f64", 5)
        self.one("theory.holds", "u8")
        self.several("displacement", "u64", 2)
        self.sequence("reference", self.reference)
        for name in ("arms", "angle", "normal_velocity"):
            self.sequence(name, self.f64)
        self.several("statistics", "f64", 2)
        self.sequence("chains", self.f64)
        self.several("temperatures", "f64", 2)
        self.sequence("chain", self.chain)
        self.one("begun", "u8")
        self.schedule("series")
        self.schedule("frames")
        self.optional("last_sample", self.totals)
        self.optional("last_frame", self.f64)
        for name in ("sample_is_old", "frame_is_old", "theory_holds"):
            self.one(name, "u8")
        self.sequence("course.sample", self.totals)
        self.one("has_rate", "u8")
        assert self.at == end
