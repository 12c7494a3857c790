// Reading of any frame of a file.
#include "tests/io/support.h"

namespace needlework::io {
namespace {

class FrameFiles : public InFolder {
 protected:
  std::string make(const std::function<void(HandMade&)>& edit, hsize_t frames) const {
    const std::string path = file("made.h5");
    HandMade made(path);
    made.put("/particles/all/box/edges", {3}, {10, 11, 12});
    const auto put = [&](const char* name, const std::vector<double>& frame) {
      std::vector<double> values;
      for (hsize_t i = 0; i < frames; ++i) {
        values.insert(values.end(), frame.begin(), frame.end());
        // The x of the centre is the number of the frame.
        if (name == std::string("position")) values[6 * i] = static_cast<double>(i);
      }
      made.put(std::string("/particles/all/") + name + "/value", {frames, 2, 3}, values);
    };
    put("position", {0, 0, 0, 1, 2, 3});
    put("velocity", {1, 2, 3, 4, 5, 6});
    put("orientation", {1, 0, 0, 0, 1, 0});
    put("angular_velocity", {0, 1, 2, 3, 0, 4});
    edit(made);
    return path;
  }
};

TEST_F(FrameFiles, EachFrameOfAWriterIsReadBitForBit) {
  const Scene scene = make_scene(20);
  Writer writer(file("a.h5"), false, scene, {});
  for (int frame = 0; frame < 5; ++frame) {
    Totals totals = make_totals(frame);
    totals.collisions = 7;  // no collisions between frames, so that their steps are equal
    State state = make_state(20, static_cast<unsigned>(frame));
    writer.write_frame(totals, state);
  }
  writer.close();
  const FrameFile frames(file("a.h5"));
  ASSERT_EQ(frames.count(), 5u);
  for (const std::size_t frame : {3u, 0u, 4u, 1u, 2u}) {
    expect_same(frames.read(frame), make_state(20, static_cast<unsigned>(frame)));
    EXPECT_EQ(frames.time(frame), make_totals(static_cast<int>(frame)).time);
  }
  EXPECT_THROW(frames.read(5), std::invalid_argument);
}

TEST_F(FrameFiles, RowsAreFramesWhereThereAreNoSteps) {
  const FrameFile frames(make([](HandMade&) {}, 4));
  ASSERT_EQ(frames.count(), 4u);
  for (std::size_t frame = 0; frame < 4; ++frame) {
    EXPECT_EQ(frames.read(frame).position[0][0], frame);
    EXPECT_EQ(frames.time(frame), std::nullopt);
  }
}

TEST_F(FrameFiles, CommonStepsAreFramesWhereStepsDiffer) {
  const FrameFile frames(make(
      [](HandMade& file) {
        file.put("/particles/all/position/step", {4}, {10, 20, 20, 40}, H5T_STD_I64LE);
        file.put("/particles/all/position/time", {4}, {1, 2, 2.5, 4});
        for (const char* name : {"velocity", "orientation", "angular_velocity"}) {
          file.put(std::string("/particles/all/") + name + "/step", {4}, {5, 10, 20, 30},
                   H5T_STD_I64LE);
        }
      },
      4));
  ASSERT_EQ(frames.count(), 2u);
  EXPECT_EQ(frames.read(0).position[0][0], 0);
  EXPECT_EQ(frames.read(1).position[0][0], 2);  // the last row of step 20
  EXPECT_EQ(frames.time(1), 2.5);
}

}  // namespace
}  // namespace needlework::io
