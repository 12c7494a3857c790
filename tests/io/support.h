// What the tests of src/io share: a folder to write in, states to write, files of odd layouts.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <functional>
#include <random>
#include <string>
#include <vector>

#include "needlework/error.h"
#include "needlework/h5md.h"
#include "src/io/hdf5.h"
#include "tests/support/message_of.h"
#include "tests/support/temporary_folder.h"

namespace needlework::io {

using test::message_of;

/// A file made by hand, dataset by dataset, as any other program might have.
class HandMade {
 public:
  explicit HandMade(const std::string& path)
      : path_(path),
        file_(H5Fcreate(path.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT), H5Fclose, path) {}

  /// Writes a dataset, its groups made on the way; `type` is that of the file.
  void put(const std::string& name, const hdf5::Shape& shape, const std::vector<double>& values,
           hid_t type = H5T_IEEE_F64LE) {
    const hdf5::Handle links(H5Pcreate(H5P_LINK_CREATE), H5Pclose, path_);
    H5Pset_create_intermediate_group(links.get(), 1);
    const hdf5::Handle space(
        shape.empty() ? H5Screate(H5S_SCALAR)
                      : H5Screate_simple(static_cast<int>(shape.size()), shape.data(), nullptr),
        H5Sclose, path_);
    if (H5Lexists(file_.get(), name.c_str(), H5P_DEFAULT) > 0) {
      H5Ldelete(file_.get(), name.c_str(), H5P_DEFAULT);
    }
    const hdf5::Handle data(H5Dcreate2(file_.get(), name.c_str(), type, space.get(), links.get(),
                                       H5P_DEFAULT, H5P_DEFAULT),
                            H5Dclose, path_);
    hdf5::check(
        H5Dwrite(data.get(), H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()),
        path_);
  }

  void remove(const std::string& name) { H5Ldelete(file_.get(), name.c_str(), H5P_DEFAULT); }

  /// Writes `frames` frames of two needles in /particles/GROUP, without box, id and image. Only the
  /// last frame is valid.
  void put_needles(const std::string& group, hsize_t frames, hid_t type = H5T_IEEE_F64LE) {
    put_frames(group + "/position", frames, {0, 10, 11, -0.5, 20, 12}, type);
    put_frames(group + "/velocity", frames, {1, 2, 3, 4, 5, 6}, type);
    put_frames(group + "/orientation", frames, {1, 0, 0, 0, 0.6, 0.8}, type);
    put_frames(group + "/angular_velocity", frames, {0, 1, 2, 3, 0.8, -0.6}, type);
  }

  void put_frames(const std::string& name, hsize_t frames, const std::vector<double>& last,
                  hid_t type = H5T_IEEE_F64LE) {
    std::vector<double> values((frames - 1) * last.size(), 99);
    values.insert(values.end(), last.begin(), last.end());
    put("/particles/" + name + "/value", {frames, last.size() / 3, 3}, values, type);
  }

  hid_t get() const { return file_.get(); }

 private:
  hdf5::Session session_;
  std::string path_;
  hdf5::Handle file_;
};

/// A folder that is gone after the test.
class InFolder : public testing::Test {
 protected:
  std::string file(const std::string& name) const { return (folder_ / name).string(); }

  std::vector<std::string> files() const {
    std::vector<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator(folder_)) {
      names.push_back(entry.path().filename().string());
    }
    return names;
  }

  /// A file of `frames` frames of two needles in /particles/GROUP with a plain box, as another
  /// program might have made it, changed by `edit`.
  std::string make(const std::function<void(HandMade&)>& edit = {}, hsize_t frames = 1,
                   const std::string& group = "all", hid_t type = H5T_IEEE_F64LE) const {
    HandMade made(file("made.h5"));
    made.put_needles(group, frames, type);
    made.put("/particles/" + group + "/box/edges", {3}, {10, 11, 12});
    if (edit) edit(made);
    return file("made.h5");
  }

  test::TemporaryFolder temporary_;
  std::filesystem::path folder_ = temporary_.path();
};

/// The size of a file as its superblock records it (version 3, at byte 28).
inline std::uint64_t recorded_size(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  std::uint64_t size = 0;
  in.seekg(28).read(reinterpret_cast<char*>(&size), sizeof size);
  return size;
}

/// A random valid state with all mantissa bits in use, and the numbers that are easily lost.
inline State make_state(std::size_t needles, unsigned seed = 1) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  const auto vector = [&] { return std::array{normal(random), normal(random), normal(random)}; };
  State state;
  state.box = {10.1, 11.7, 2.3e1 / 3};
  for (std::size_t i = 0; i < needles; ++i) {
    auto u = vector();
    const double length = std::hypot(u[0], u[1], u[2]);
    for (double& component : u) component /= length;
    auto w = vector();
    const double along = w[0] * u[0] + w[1] * u[1] + w[2] * u[2];
    for (std::size_t axis = 0; axis < 3; ++axis) w[axis] -= along * u[axis];
    state.position.push_back(vector());
    state.velocity.push_back(vector());
    state.orientation.push_back(u);
    state.angular_velocity.push_back(w);
    state.image.push_back({static_cast<std::int32_t>(i) - 3, 1 << 30, -(1 << 30)});
    state.id.push_back(static_cast<std::uint32_t>(3 * (needles - i)));
  }
  if (needles > 1) {
    state.position[0] = {-0.0, 5e-324, 1.7976931348623157e308};
    state.velocity[0] = {1e-310, -2.2250738585072014e-308, 1 / 3.0};
    state.angular_velocity[1] = {0, -0.0, 0};
  }
  return state;
}

inline Scene make_scene(std::uint64_t needles, bool events = false) {
  Scene scene;
  scene.needles.count = needles;
  scene.needles.k = 6;
  scene.needles.seed = 18446744073709551615u;
  scene.collisions.epsilon = 0.8;
  scene.output.events = events;
  scene.title = "Nadeln & é";
  scene.text = "[needles]\ncount = 7\n";
  return scene;
}

inline Totals make_totals(int step) {
  Totals totals;
  totals.time = step / 8.0;
  totals.t_tr = 1.0 / (step + 1);
  totals.t_rot = 2.0 / (step + 1);
  totals.energy = 3.5 / (step + 1);
  totals.momentum = {step + 0.25, step + 0.5, step + 0.75};
  totals.collisions = static_cast<std::uint64_t>(10 * step);
  totals.tc_collisions = static_cast<std::uint64_t>(step);
  return totals;
}

template <class Row>
bool same_bits(const std::vector<Row>& a, const std::vector<Row>& b) {
  return a.size() == b.size() &&
         (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(Row)) == 0);
}

inline void expect_same(const State& a, const State& b) {
  EXPECT_EQ(0, std::memcmp(a.box.data(), b.box.data(), sizeof a.box));
  EXPECT_TRUE(same_bits(a.position, b.position));
  EXPECT_TRUE(same_bits(a.velocity, b.velocity));
  EXPECT_TRUE(same_bits(a.orientation, b.orientation));
  EXPECT_TRUE(same_bits(a.angular_velocity, b.angular_velocity));
  EXPECT_EQ(a.image, b.image);
  EXPECT_EQ(a.id, b.id);
}

/// What readers of frames say against a file, without its name.
template <class Error>
std::string complaint_about(const std::string& path) {
  const std::string message = message_of<Error>([&] { read_last_frame(path); });
  EXPECT_TRUE(message.starts_with(path + ": ")) << message;
  return message.substr(std::min(message.size(), path.size() + 2));
}

/// All numbers of a dataset.
inline std::vector<double> read_numbers(const std::string& path, const std::string& dataset) {
  const hdf5::Session session;
  const hdf5::Handle file(H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), H5Fclose, path);
  const hdf5::Handle data = hdf5::open_dataset(file.get(), dataset, path);
  std::size_t size = 1;
  for (const hsize_t extent : hdf5::shape_of(data.get(), path)) size *= extent;
  std::vector<double> values(size);
  hdf5::check(H5Dread(data.get(), H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()),
              path);
  return values;
}

}  // namespace needlework::io
