// Reading of files as other programs may write them: what is accepted, and the messages of what is
// refused.
#include <fstream>
#include <limits>

#include "tests/io/support.h"
#include "tests/support/contains.h"

namespace needlework::io {
namespace {

using hdf5::Shape;

using Edit = std::function<void(HandMade&)>;

class Reading : public InFolder {
 protected:
  std::string complaint(const Edit& edit, hsize_t frames = 1) {
    return complaint_about<InputError>(make(edit, frames));
  }
};

const Edit unchanged;

// Of the needles: another dataset, none, and steps of all elements.
Edit put(const std::string& name, const Shape& shape, const std::vector<double>& values,
         hid_t type = H5T_IEEE_F64LE) {
  return [=](HandMade& file) { file.put("/particles/all/" + name, shape, values, type); };
}
Edit without(const std::string& name) {
  return [=](HandMade& file) { file.remove("/particles/all" + name); };
}
Edit with_steps(const Shape& shape, const std::vector<double>& steps) {
  return [=](HandMade& file) {
    for (const char* name : {"position", "velocity", "orientation", "angular_velocity"}) {
      put(name + std::string("/step"), shape, steps, H5T_STD_I32LE)(file);
    }
  };
}

const std::array<double, 3> box{10, 11, 12};

void expect_made(const State& state) {
  EXPECT_EQ(state.box, box);
  ASSERT_EQ(state.size(), 2u);
  // On an edge of the box and outside.
  EXPECT_EQ(state.position[0], (std::array<double, 3>{0, 10, 11}));
  EXPECT_EQ(state.position[1], (std::array<double, 3>{-0.5, 20, 12}));
  EXPECT_EQ(state.velocity[1], (std::array<double, 3>{4, 5, 6}));
  EXPECT_EQ(state.orientation[0], (std::array<double, 3>{1, 0, 0}));
  EXPECT_EQ(state.angular_velocity[0], (std::array<double, 3>{0, 1, 2}));
}

TEST_F(Reading, TheLeastThatIsNeededIsRead) {
  for (const hsize_t frames : {1u, 2u, 3u, 7u}) {
    const State state = read_last_frame(make(unchanged, frames));
    expect_made(state);
    EXPECT_TRUE(state.image.empty());
    EXPECT_TRUE(state.id.empty());
  }
}

TEST_F(Reading, AnyNameOfTheOnlyGroupIsAccepted) {
  expect_made(read_last_frame(make(unchanged, 2, "needles")));
  expect_made(read_last_frame(make(unchanged, 2, "trajectory")));
}

TEST_F(Reading, NeedlesIsPreferredToOtherGroups) {
  expect_made(read_last_frame(
      make([](HandMade& file) { file.put("/particles/atoms/x", {1}, {0}); }, 2, "needles")));
}

TEST_F(Reading, PlainDatasetsAreAccepted) {
  expect_made(read_last_frame(make([](HandMade& file) {
    for (const char* name : {"position", "velocity", "orientation", "angular_velocity"}) {
      const std::string path = std::string("/particles/all/") + name;
      H5Lmove(file.get(), (path + "/value").c_str(), file.get(), "/aside", H5P_DEFAULT,
              H5P_DEFAULT);
      file.remove(path);
      H5Lmove(file.get(), "/aside", file.get(), path.c_str(), H5P_DEFAULT, H5P_DEFAULT);
    }
  })));
  expect_made(read_last_frame(make([](HandMade& file) {
    file.remove("/particles/all/position");
    file.put("/particles/all/position", {2, 3}, {0, 10, 11, -0.5, 20, 12});
  })));
}

TEST_F(Reading, OtherKindsOfNumbersAreAccepted) {
  for (const hid_t type : {H5T_IEEE_F32LE, H5T_IEEE_F32BE, H5T_IEEE_F64BE}) {
    const State state = read_last_frame(make(unchanged, 2, "all", type));
    expect_made(state);
    EXPECT_NEAR(state.orientation[1][1], 0.6, 1e-7);
  }
  expect_made(
      read_last_frame(make(put("velocity/value", {1, 2, 3}, {1, 2, 3, 4, 5, 6}, H5T_STD_I16BE))));
}

TEST_F(Reading, BoxEdgesOfAllShapesAreAccepted) {
  const std::vector<double> row{10, 11, 12};
  const std::vector<double> matrix{10, 0, 0, 0, 11, 0, 0, 0, 12};
  const auto repeat = [](const std::vector<double>& values, int count) {
    std::vector<double> all;
    for (int i = 0; i < count; ++i) all.insert(all.end(), values.begin(), values.end());
    return all;
  };
  for (const int frames : {1, 2, 3, 4}) {
    const auto count = static_cast<hsize_t>(frames);
    const std::vector<std::pair<Shape, std::vector<double>>> layouts{
        {{3}, row},
        {{3, 3}, matrix},
        {{count, 3}, repeat(row, frames)},
        {{count, 3, 3}, repeat(matrix, frames)}};
    for (const auto& [shape, values] : layouts) {
      for (const bool group : {false, true}) {
        // In an element of three frames, [3][3] is three rows.
        if (group && frames == 3 && values == matrix) continue;
        SCOPED_TRACE(testing::Message() << hdf5::to_string(shape) << ", group " << group << ", "
                                        << frames << " frames");
        const auto& numbers = values;
        const auto& dimensions = shape;
        expect_made(read_last_frame(make(
            [&](HandMade& file) {
              file.remove("/particles/all/box/edges");
              const std::string name = "/particles/all/box/edges";
              file.put(group ? name + "/value" : name, dimensions, numbers);
            },
            count)));
      }
    }
  }
}

TEST_F(Reading, BoxOfTheLastFrameCounts) {
  const State state = read_last_frame(make(
      [](HandMade& file) {
        file.remove("/particles/all/box/edges");
        file.put("/particles/all/box/edges/value", {3, 3}, {1, 1, 1, 2, 2, 2, 10, 11, 12});
      },
      3));
  EXPECT_EQ(state.box, box);
}

TEST_F(Reading, IdsOfAllLayoutsAreAccepted) {
  const std::vector<std::uint32_t> ids{4294967295u, 7};
  EXPECT_EQ(read_last_frame(make(put("id", {2}, {4294967295.0, 7}, H5T_STD_U32LE))).id, ids);
  EXPECT_EQ(
      read_last_frame(make(put("id/value", {2, 2}, {1, 1, 4294967295.0, 7}, H5T_STD_I64LE), 2)).id,
      ids);
}

TEST_F(Reading, ImagesOfAllKindsAreAccepted) {
  const std::vector<std::array<std::int32_t, 3>> images{{1, -2, 3}, {-4, 5, -2147483647}};
  for (const hid_t type : {H5T_STD_I32LE, H5T_STD_I64BE, H5T_IEEE_F64LE}) {
    EXPECT_EQ(
        read_last_frame(make(put("image/value", {1, 2, 3}, {1, -2, 3, -4, 5, -2147483647}, type)))
            .image,
        images);
  }
}

TEST_F(Reading, ElementsAreMatchedByStep) {
  // Positions go on to step 40, the last step of all is 30.
  const auto with_velocities_at = [](const std::vector<double>& steps) {
    return [=](HandMade& file) {
      put("position/value", {4, 2, 3},
          {9, 9, 9, 9, 9, 9, 9, 9, 9, 9, 9, 9, 0, 10, 11, -0.5, 20, 12, 9, 9, 9, 9, 9, 9})(file);
      put("position/step", {4}, {10, 20, 30, 40}, H5T_STD_I64LE)(file);
      put("velocity/step", {2}, steps, H5T_STD_I64LE)(file);
      put("orientation/step", {2}, {0, 30}, H5T_STD_I64LE)(file);
      put("angular_velocity/step", {2}, {20, 30}, H5T_STD_I64LE)(file);
    };
  };
  expect_made(read_last_frame(make(with_velocities_at({10, 30}), 2)));
  EXPECT_EQ(complaint(with_velocities_at({11, 31}), 2),
            "/particles/all/angular_velocity/value: no step in common with the other elements: "
            "expected one");
}

TEST_F(Reading, StepsMayBeAnIncrement) {
  expect_made(read_last_frame(make(with_steps({}, {5}), 4)));
}

TEST_F(Reading, RowsWithoutAStepDoNotCount) {
  expect_made(read_last_frame(make(
      [](HandMade& file) {
        put("velocity/value", {3, 2, 3},
            {9, 9, 9, 9, 9, 9, 1, 2, 3, 4, 5, 6, 9, 9, 9, 9, 9, 9})(file);
        with_steps({2}, {0, 1})(file);
      },
      2)));
}

TEST_F(Reading, MissingThingsAreNamed) {
  for (const std::string name : {"position", "velocity", "orientation", "angular_velocity"}) {
    EXPECT_EQ(complaint(without("/" + name)),
              "/particles/all/" + name + ": missing: expected a dataset");
    EXPECT_EQ(complaint(without("/" + name + "/value")),
              "/particles/all/" + name + "/value: missing: expected a dataset");
  }
  EXPECT_EQ(complaint(without("/box")), "/particles/all/box/edges: missing: expected edges");
  EXPECT_EQ(complaint([](HandMade& file) {
              file.remove("/particles/all/box");
              file.put("/particles/all/box", {3}, {10, 11, 12});
            }),
            "/particles/all/box/edges: missing: expected edges");
  EXPECT_EQ(complaint([](HandMade& file) { file.remove("/particles"); }),
            "/particles: missing: expected a group, as in H5MD files");
  EXPECT_EQ(complaint(without("")), "/particles: 0 groups: expected one, or one named needles");
  EXPECT_EQ(complaint([](HandMade& file) { file.put("/particles/more/x", {1}, {0}); }),
            "/particles: 2 groups: all, more: expected one, or one named needles");
}

TEST_F(Reading, WrongShapesAreRefused) {
  const auto shape = [&](const std::string& name, const Shape& shape) {
    std::size_t size = 1;
    for (const hsize_t extent : shape) size *= extent;
    return complaint([&](HandMade& file) {
      file.remove("/particles/all/" + name);
      file.put("/particles/all/" + name, shape, std::vector<double>(std::max(size, size_t{1}), 1));
    });
  };
  EXPECT_EQ(shape("velocity/value", {1, 3, 3}),
            "/particles/all/velocity/value: shape [1][3][3]: expected [1][2][3]");
  EXPECT_EQ(shape("velocity/value", {1, 2, 2}),
            "/particles/all/velocity/value: shape [1][2][2]: expected [1][2][3]");
  EXPECT_EQ(shape("velocity/value", {2, 3}),
            "/particles/all/velocity/value: shape [2][3]: expected [2][2][3]");
  EXPECT_EQ(shape("orientation", {6}), "/particles/all/orientation: shape [6]: expected [2][3]");
  EXPECT_EQ(shape("position/value", {6}),
            "/particles/all/position/value: shape [6]: expected [frames][needles][3]");
  EXPECT_EQ(shape("position/value", {}),
            "/particles/all/position/value: shape []: expected [frames][needles][3]");
  EXPECT_EQ(shape("box/edges", {2}),
            "/particles/all/box/edges: shape [2]: expected [3], [3][3], [frames][3] or "
            "[frames][3][3]");
  EXPECT_EQ(shape("id", {3}), "/particles/all/id: shape [3]: expected [2] or [frames][2]");
  EXPECT_EQ(shape("image/value", {1, 2, 4}),
            "/particles/all/image/value: shape [1][2][4]: expected [1][2][3]");
}

TEST_F(Reading, UnequalNumbersOfFramesAreRefused) {
  EXPECT_EQ(complaint(put("velocity/value", {1, 2, 3}, {1, 2, 3, 4, 5, 6}), 2),
            "/particles/all/velocity/value: 1 frames: expected 2, as in "
            "/particles/all/position/value");
  EXPECT_EQ(complaint(put("velocity/step", {2}, {0, 1}, H5T_STD_I32LE)),
            "/particles/all/velocity/step: 2 steps: expected 1, one for each row of "
            "/particles/all/velocity/value");
}

TEST_F(Reading, NoFramesAreRefused) {
  EXPECT_EQ(complaint([](HandMade& file) {
              for (const char* name : {"position", "velocity", "orientation", "angular_velocity"}) {
                file.put(std::string("/particles/all/") + name + "/value", {0, 2, 3}, {});
              }
            }),
            "/particles/all/position/value: no frames: expected at least one");
  Writer(file("header.h5"), false, make_scene(2), {}).close();
  const auto message = message_of<InputError>([&] { read_last_frame(file("header.h5")); });
  EXPECT_TRUE(message.ends_with("no frames: expected at least one")) << message;
}

TEST_F(Reading, StepsOutOfOrderAreRefused) {
  EXPECT_EQ(complaint(put("position/step", {3}, {0, 7, 5}, H5T_STD_I32LE), 3),
            "/particles/all/position/step[2] = 5: expected 7 or more, which is the step before it");
}

TEST_F(Reading, EvenStepsBeyond64BitsAreRefused) {
  EXPECT_EQ(complaint(put("position/step", {}, {0x1p62}, H5T_STD_I64LE), 3),
            "/particles/all/position/step: 0 + 2 x 4611686018427387904: expected a number of 64 "
            "bits");
}

TEST_F(Reading, WrongNumbersAreNamedWithTheirPlace) {
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  constexpr double infinity = std::numeric_limits<double>::infinity();
  const auto put = [&](const std::string& name, const std::vector<double>& values) {
    return complaint(
        [&](HandMade& file) { file.put_frames("all/" + name, 3, values, H5T_IEEE_F64LE); }, 3);
  };
  EXPECT_EQ(put("position", {0, 0, 0, 0, nan, 0}),
            "/particles/all/position/value[2][1][1] = nan: expected a finite number");
  EXPECT_EQ(put("velocity", {0, 0, -infinity, 0, 0, 0}),
            "/particles/all/velocity/value[2][0][2] = -inf: expected a finite number");
  EXPECT_EQ(put("orientation", {1, 0, 0, 0, 0, 0}),
            "/particles/all/orientation/value[2][1] = (0, 0, 0), of length 0: expected a unit "
            "vector, within 1e-06");
  EXPECT_EQ(put("orientation", {1.000002, 0, 0, 0, 0.6, 0.8}),
            "/particles/all/orientation/value[2][0] = (1.000002, 0, 0), of length 1.000002: "
            "expected a unit vector, within 1e-06");
  EXPECT_EQ(put("image", {0, 0, 0.5, 0, 0, 0}),
            "/particles/all/image/value[2][0][2] = 0.5: expected a whole number of 32 bits");
  EXPECT_EQ(put("image", {0, 0, 0, 0, 0, 3e9}),
            "/particles/all/image/value[2][1][2] = 3000000000: expected a whole number of 32 bits");
}

TEST_F(Reading, DirectorsWithinTheToleranceAreTakenAsTheyAre) {
  const State state = read_last_frame(make([](HandMade& file) {
    file.put_frames("all/orientation", 1, {1 - 9e-7, 0, 0, 0, 0.6, 0.8});
    file.put_frames("all/angular_velocity", 1, {9e-7, 0, 1, 0, 0, 0});
  }));
  EXPECT_EQ(state.orientation[0][0], 1 - 9e-7);
  EXPECT_EQ(state.angular_velocity[0][0], 9e-7);
}

TEST_F(Reading, WrongIdsAreRefused) {
  const auto found = [&](const std::vector<double>& values, hid_t type) {
    return complaint(put("id", {2}, values, type));
  };
  EXPECT_EQ(found({7, 7}, H5T_STD_I32LE),
            "/particles/all/id[1] = 7: expected an id other than that of entry 0");
  EXPECT_EQ(found({7, -1}, H5T_STD_I32LE),
            "/particles/all/id[1] = -1: expected a whole number from 0 to 2^32 - 1");
  EXPECT_EQ(found({4294967296.0, 1}, H5T_STD_I64LE),
            "/particles/all/id[0] = 4294967296: expected a whole number from 0 to 2^32 - 1");
  EXPECT_EQ(found({0.5, 1}, H5T_IEEE_F64LE),
            "/particles/all/id[0] = 0.5: expected a whole number from 0 to 2^32 - 1");
}

TEST_F(Reading, WrongBoxesAreRefused) {
  const auto found = [&](const Shape& shape, const std::vector<double>& values,
                         hsize_t frames = 1) {
    return complaint(put("box/edges", shape, values), frames);
  };
  const std::string edges = "/particles/all/box/edges";
  EXPECT_EQ(found({3, 3}, {10, 0, 0, 0, 10, 0, 0, 2.5, 10}),
            edges + "[2][1] = 2.5: expected 0, a box that is rectangular or tilted along x by y");
  EXPECT_EQ(found({3, 3}, {10, 1, 1, 1, 10, 1, 1, 1, 10}, 3),
            edges + "[0][1] = 1: expected 0, a box that is rectangular or tilted along x by y");
  EXPECT_EQ(
      found({1, 3, 3}, {10, 0, 1e-9, 0, 10, 0, 0, 0, 10}),
      edges + "[0][0][2] = 1e-09: expected 0, a box that is rectangular or tilted along x by y");
  EXPECT_EQ(found({3}, {10, 0, 10}), edges + ", axis 1 = 0: expected an edge above 0");
  EXPECT_EQ(found({3}, {10, 10, -1}), edges + ", axis 2 = -1: expected an edge above 0");
  EXPECT_EQ(found({3}, {std::numeric_limits<double>::quiet_NaN(), 10, 1}),
            edges + ", axis 0 = nan: expected an edge above 0");
  EXPECT_EQ(found({3}, {std::numeric_limits<double>::infinity(), 10, 1}),
            edges + ", axis 0 = inf: expected an edge above 0");
  EXPECT_EQ(found({2, 3}, {1, 1, 1, 1, 1, 1}, 4),
            edges + ": 2 frames: expected 4, as in /particles/all/position/value");
}

TEST_F(Reading, BoxesSayAlongWhichAxesTheyArePeriodic) {
  const auto boundary = [](const std::vector<std::string>& values) {
    return [values](HandMade& file) {
      const hdf5::Handle group = hdf5::open_group(file.get(), "/particles/all/box", "");
      hdf5::write_attribute(group.get(), "boundary", values, "");
    };
  };
  expect_made(read_last_frame(make(boundary({"periodic", "periodic", "periodic"}))));
  EXPECT_EQ(read_last_frame(make(boundary({"periodic", "none", "periodic"}))).periodic,
            (std::array{true, false, true}));
  EXPECT_EQ(read_last_frame(make(boundary({"none"}))).periodic, (std::array{false, false, false}));
  EXPECT_EQ(read_last_frame(make([](HandMade&) {})).periodic, (std::array{true, true, true}));
  EXPECT_EQ(complaint(boundary({"periodic", "open", "periodic"})),
            "/particles/all/box: boundary = open: expected periodic or none");
  EXPECT_EQ(complaint(boundary({"periodic", "none"})),
            "/particles/all/box: boundary of 2 words: expected one for each axis");
}

TEST_F(Reading, OtherThanNumbersAreRefused) {
  EXPECT_EQ(
      complaint([](HandMade& file) {
        file.remove("/particles/all/velocity");
        const hdf5::Handle group = hdf5::open_group(file.get(), "/particles/all", "");
        hdf5::write_scalar(group.get(), "velocity", std::string("fast"), "");
      }),
      "/particles/all/velocity: the values are not numbers: expected floating point or integers");
}

// A chunked dataset takes no room in the file before it is written, whatever its shape.
TEST_F(Reading, MoreNumbersThanTheFileCanHoldAreRefusedBeforeMemoryIsTaken) {
  const auto declare = [](HandMade& file, const char* name, hdf5::Shape shape, hid_t type) {
    const hdf5::Handle group = hdf5::open_group(file.get(), "/particles/all", "");
    const hdf5::Handle space(
        H5Screate_simple(static_cast<int>(shape.size()), shape.data(), nullptr), H5Sclose, "");
    const hdf5::Handle layout(H5Pcreate(H5P_DATASET_CREATE), H5Pclose, "");
    hdf5::Shape chunk(shape.size(), 1);
    H5Pset_chunk(layout.get(), static_cast<int>(chunk.size()), chunk.data());
    const hdf5::Handle dataset(
        H5Dcreate2(group.get(), name, type, space.get(), H5P_DEFAULT, layout.get(), H5P_DEFAULT),
        H5Dclose, "");
  };
  const auto complaint_of = [&](const char* name, const hdf5::Shape& shape) {
    return complaint([&](HandMade& file) {
      if (std::string_view(name) == "velocity") file.remove("/particles/all/velocity");
      declare(file, name, shape, H5T_IEEE_F64LE);
    });
  };
  const hsize_t many = hsize_t{1} << 32;
  EXPECT_TRUE(test::contains(complaint_of("velocity", {many, 3}),
                             "velocity: 12884901888 numbers: expected "));
  EXPECT_TRUE(
      test::contains(complaint_of("velocity", {many, many, many}), "18446744073709551615 numbers"));
  EXPECT_TRUE(
      test::contains(complaint_of("image", {many, 3}), "image: 12884901888 numbers: expected "));
}

TEST_F(Reading, WhatIsNotAWholeHdf5FileIsNamed) {
  const auto message = [](const std::string& path) {
    return message_of<IoError>([&] { read_last_frame(path); });
  };
  EXPECT_EQ(message(file("none.h5")), file("none.h5") + ": No such file or directory");
  EXPECT_EQ(message(folder_.string()), folder_.string() + ": Is a directory");
  EXPECT_EQ(message("/dev/null"), "/dev/null: not a regular file");
  std::ofstream(file("empty.h5")).flush();
  EXPECT_EQ(message(file("empty.h5")), file("empty.h5") + ": not an HDF5 file");
  std::ofstream(file("text.h5")) << std::string(5000, 'x');
  EXPECT_EQ(message(file("text.h5")), file("text.h5") + ": not an HDF5 file");
}

// Every length from a bare signature on; the file is that of a killed program and that of a closed
// one.
TEST_F(Reading, FilesCutShortAreRefused_long) {
  const State state = make_state(40);
  Writer writer(file("whole.h5"), false, make_scene(40), {});
  for (int frame = 0; frame < 20; ++frame) writer.write_frame(make_totals(frame), state);
  writer.flush();
  std::filesystem::copy_file(file("whole.h5"), file("left.h5"));
  writer.close();
  // The content ends with the last byte that the superblock counts. The file that a killed run has
  // left is longer.
  const auto size_of = [&](const char* name) { return std::filesystem::file_size(file(name)); };
  EXPECT_EQ(size_of("whole.h5"), recorded_size(file("whole.h5")));
  EXPECT_GT(size_of("left.h5"), recorded_size(file("left.h5")));
  for (const char* name : {"whole.h5", "left.h5"}) {
    expect_same(state, read_last_frame(file(name)));
    const auto cut_at = [&](std::uintmax_t size) {
      std::filesystem::copy_file(file(name), file("cut.h5"),
                                 std::filesystem::copy_options::overwrite_existing);
      std::filesystem::resize_file(file("cut.h5"), size);
    };
    const std::uintmax_t size = recorded_size(file(name));
    for (std::uintmax_t cut = 8; cut < size;
         cut = std::max(cut + 1, std::min(cut + cut / 15, size - 1))) {
      cut_at(cut);
      const auto message = message_of<IoError>([&] { read_last_frame(file("cut.h5")); });
      EXPECT_TRUE(message.starts_with(file("cut.h5") + ": damaged or cut short: ")) << message;
      EXPECT_THROW(describe(file("cut.h5")), IoError);
    }
    cut_at(size);
    expect_same(state, read_last_frame(file("cut.h5")));
    const auto after_first_line = [](const std::string& text) {
      return text.substr(text.find('\n'));
    };
    EXPECT_EQ(after_first_line(describe(file("cut.h5"))), after_first_line(describe(file(name))));
  }
}

TEST_F(Reading, AnOverviewShowsWhatAFileContains) {
  Writer writer(file("a.h5"), false, make_scene(7, true), {"avx2", 2, 0.125});
  for (int frame = 0; frame < 3; ++frame) writer.write_frame(make_totals(frame), make_state(7));
  for (int i = 0; i < 4; ++i) writer.write_series(make_totals(10 * i));
  Collision collision;
  for (int i = 0; i < 5; ++i) collision.time = i, writer.write_event(collision);
  writer.close();
  const std::string text = describe(file("a.h5"));
  EXPECT_TRUE(test::contains(
      text, {
                "H5MD 1.1, written by needlework ",
                "/particles/needles: 7 particles, 3 frames, time 0 to 0.25, step 0 to 20\n",
                "/series: 4 samples, time 0 to 3.75, step 0 to 300\n",
                "/events: 5 collisions, time 0 to 4\n",
                "\n  needles\n      State of all needles at the times of the frames.\n",
                "    position/value           float64  [3][7][3]\n"
                "        Centre of each needle, inside the box, in units of length, with shape "
                "[frames][needles][3].\n",
                "  energy/value               float64  [4]\n",
                "  pair                       uint32   [5][2]\n",
                "  seed           18446744073709551615   Seed of the random numbers",
                "  epsilon        0.8                    Coefficient of normal restitution.\n",
                "  threads        2 ",
                "  isa            avx2 ",
                "  title          Nadeln & é ",
                "scene:\n[needles]\ncount = 7\n",
            }));
}

TEST_F(Reading, AnOverviewOfOtherFilesShowsTheirDatasets) {
  const std::string text = describe(make(unchanged, 2));
  EXPECT_TRUE(test::contains(text, {"not H5MD", "/particles/all: 2 particles, 2 frames"}));
  const std::string odd = describe(make([](HandMade& file) {
    file.put("/parameters/list", {2}, {1, 2});
    file.put("/parameters/number", {}, {-5}, H5T_STD_I16LE);
    file.put("/observables/energy/value", {2}, {3, 4});
    file.put("/observables/energy/step", {2}, {10, 30}, H5T_STD_I64LE);
    H5Lcreate_soft("/nowhere", file.get(), "/dangling", H5P_DEFAULT, H5P_DEFAULT);
    H5Lcreate_hard(file.get(), "/", file.get(), "/particles/circle", H5P_DEFAULT, H5P_DEFAULT);
  }));
  EXPECT_TRUE(test::contains(odd, {"dangling", "number         -5\n",
                                   "energy/value               float64  [2], step 10 to 30\n"}));
  EXPECT_LT(odd.size(), 100000u);
}

}  // namespace
}  // namespace needlework::io
