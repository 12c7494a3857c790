// Files that were damaged, or made to do damage: each is an error that names it, within seconds and
// without much memory, and nothing but the file itself is read.
#include <fcntl.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>
#include <zlib.h>

#include <fstream>
#include <iterator>
#include <random>

#include "src/io/contents.h"
#include "tests/io/support.h"
#include "tests/support/contains.h"
#include "tests/support/whole_file.h"

namespace needlework::io {
namespace {

using hdf5::Handle;
using hdf5::Shape;

void write_bytes(const std::string& path, const std::string& bytes) {
  std::ofstream(path, std::ios::binary).write(bytes.data(), std::ssize(bytes));
}

// What all readers say of a file, one line each; "read" where they take it. Anything else than the
// exceptions of bad input fails the test, or ends it.
std::vector<std::string> verdicts(const std::string& path) {
  std::vector<std::string> out;
  for (const std::function<void()>& read :
       {std::function<void()>([&] { read_last_frame(path); }),
        std::function<void()>([&] { describe(path); }),
        std::function<void()>([&] { read_run(path); }), std::function<void()>([&] {
          const Contents contents(path);
          for (const std::string& name : contents.names("/series")) {
            if (contents.is_dataset("/series/" + name)) contents.numbers("/series/" + name);
          }
        })}) {
    try {
      read();
      out.push_back("read");
    } catch (const InputError& error) {
      out.push_back(error.what());
    } catch (const IoError& error) {
      out.push_back(error.what());
    }
    EXPECT_TRUE(out.back() == "read" || out.back().starts_with(path + ": ")) << out.back();
  }
  return out;
}

class Hostile : public InFolder {
 protected:
  std::string make_run() {
    const std::string path = file("run.h5");
    Writer writer(path, true, make_scene(2, true), {});
    for (int frame = 0; frame < 2; ++frame) {
      writer.write_frame(make_totals(frame), make_state(2));
      writer.write_series(make_totals(frame));
      writer.write_event(Collision());
    }
    writer.close();
    return path;
  }
  // The positions, which are then to be made again.
  static constexpr const char* positions = "/particles/all/position/value";
};

TEST_F(Hostile, FilesThatAreCutShortAreRefused) {
  const std::string whole = test::bytes_of(make_run()), path = file("cut.h5");
  std::mt19937_64 random(1);
  for (int n = 0; n < 30; ++n) {
    write_bytes(path, whole.substr(0, random() % whole.size()));
    for (const std::string& verdict : verdicts(path)) EXPECT_NE(verdict, "read");
  }
}

// Half of the flips are near the beginning and the end, where HDF5 has its own data.
TEST_F(Hostile, FlippedBitsEndNoReader) {
  const std::string whole = test::bytes_of(make_run()), path = file("flipped.h5");
  std::mt19937_64 random(2);
  int refused = 0;
  for (int n = 0; n < 40; ++n) {
    std::string bytes = whole;
    const std::size_t range = n % 2 ? bytes.size() : std::min<std::size_t>(bytes.size(), 4096);
    const std::size_t at = random() % range;
    bytes[n % 4 < 2 ? at : bytes.size() - 1 - at] ^= static_cast<char>(1 << (random() % 8));
    write_bytes(path, bytes);
    for (const std::string& verdict : verdicts(path)) refused += verdict != "read";
  }
  EXPECT_GT(refused, 4);
}

// As in CVE-2021-37501: the size of an attribute overflows, so that HDF5 takes too little memory
// for it and writes beyond. HDF5 1.10.8 has this defect.
TEST_F(Hostile, AttributesWhoseSizeOverflowsAreRefused) {
  constexpr std::uint64_t before = 0x1234, after = std::uint64_t{1} << 61;
  const std::string path = make([&](HandMade& made) {
    const hsize_t extent = before;
    const Handle space(H5Screate_simple(1, &extent, nullptr), H5Sclose, "");
    const Handle box(H5Gopen2(made.get(), "/particles/all/box", H5P_DEFAULT), H5Gclose, "");
    const Handle text(H5Tcopy(H5T_C_S1), H5Tclose, "");
    H5Tset_size(text.get(), 8);
    const Handle attribute(
        H5Acreate2(box.get(), "boundary", text.get(), space.get(), H5P_DEFAULT, H5P_DEFAULT),
        H5Aclose, "");
    const std::string texts(8 * before, 'x');
    H5Awrite(attribute.get(), text.get(), texts.data());
  });
  std::string bytes = test::bytes_of(path);
  const std::string mark(reinterpret_cast<const char*>(&before), sizeof before);
  int found = 0;
  for (auto at = bytes.find(mark); at != bytes.npos; at = bytes.find(mark, at + 1), ++found) {
    std::memcpy(bytes.data() + at, &after, sizeof after);
  }
  ASSERT_GT(found, 0);
  write_bytes(path, bytes);
  // HDF5 1.14 refuses them itself.
  const auto is_refused = [&](const std::string& reason) {
    try {
      read_last_frame(path);
    } catch (const std::exception& error) {
      return std::string(error.what()).find(reason) != std::string::npos;
    }
    return false;
  };
  EXPECT_TRUE(is_refused("2305843009213693952 texts of 8 bytes") ||
              is_refused("HDF5: data size exceeds addressable range"));
}

// Zeros, compressed twice: a file of some kilobytes that stands for gigabytes.
std::string compressed_zeros(std::uint64_t size) {
  // Blocks of compressed zeros that do not refer to those before are all equal.
  const std::vector<Bytef> zeros(1 << 20, 0);
  std::vector<Bytef> block(zeros.size());
  z_stream stream{};
  deflateInit(&stream, 9);
  std::string head, body;
  for (std::string* part : {&head, &body}) {
    stream.next_in = const_cast<Bytef*>(zeros.data());
    stream.avail_in = static_cast<uInt>(zeros.size());
    stream.next_out = block.data();
    stream.avail_out = static_cast<uInt>(block.size());
    deflate(&stream, Z_FULL_FLUSH);
    part->assign(reinterpret_cast<char*>(block.data()), block.size() - stream.avail_out);
  }
  deflateEnd(&stream);
  std::string all = head;
  for (std::uint64_t n = 1; n < size / zeros.size(); ++n) all += body;
  all += {'\x03', '\x00'};  // the last block, empty
  const std::uint64_t adler = (size % 65521) << 16 | 1;
  for (int shift = 24; shift >= 0; shift -= 8) all += static_cast<char>(adler >> shift & 255);
  uLongf length = compressBound(all.size());
  std::string twice(length, '\0');
  compress2(reinterpret_cast<Bytef*>(twice.data()), &length,
            reinterpret_cast<const Bytef*>(all.data()), all.size(), 9);
  return twice.substr(0, length);
}

TEST_F(Hostile, CompressedBombsAreRefused_long) {
  const hsize_t needles = hsize_t{3} << 27;  // 9.7 GB
  const std::string bomb = compressed_zeros(std::uint64_t{3} << 30);
  ASSERT_LT(bomb.size(), 100000u);
  const std::string path = make([&](HandMade& made) {
    const Shape shape{1, 2, 3}, chunk{1, needles / 3, 1};
    const Shape most{1, needles, 3};
    made.remove(positions);
    const Handle space(H5Screate_simple(3, shape.data(), most.data()), H5Sclose, "");
    const Handle layout(H5Pcreate(H5P_DATASET_CREATE), H5Pclose, "");
    H5Pset_chunk(layout.get(), 3, chunk.data());
    H5Pset_deflate(layout.get(), 9);
    H5Pset_deflate(layout.get(), 9);
    const Handle data(H5Dcreate2(made.get(), positions, H5T_IEEE_F64LE, space.get(), H5P_DEFAULT,
                                 layout.get(), H5P_DEFAULT),
                      H5Dclose, "");
    for (hsize_t axis = 0; axis < 3; ++axis) {
      const hsize_t offset[] = {0, 0, axis};
      hdf5::check(H5Dwrite_chunk(data.get(), H5P_DEFAULT, 0, offset, bomb.size(), bomb.data()), "");
    }
  });
  EXPECT_LT(std::filesystem::file_size(path), 100000u);
  EXPECT_NE(verdicts(path)[0], "read");
  rusage children{};
  getrusage(RUSAGE_CHILDREN, &children);
  EXPECT_LT(children.ru_maxrss, 2500000) << "kB";
}

// Opening a pipe would wait for a writer for ever.
TEST_F(Hostile, NoOtherFileIsOpened) {
  const std::string other = file("other.h5"), pipe = file("pipe");
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  std::filesystem::copy_file(make(), other);
  for (const std::string& target : {other, pipe}) {
    const std::string direct = make([&](HandMade& made) {
      made.remove("/particles/all/position");
      H5Lcreate_external(target.c_str(), "/particles/all/position", made.get(),
                         "/particles/all/position", H5P_DEFAULT, H5P_DEFAULT);
    });
    EXPECT_EQ(complaint_about<InputError>(direct),
              "/particles/all/position: a link that leads out of the file, or to itself: expected "
              "a dataset");
    const std::string indirect = make([&](HandMade& made) {
      made.remove("/particles/all/position");
      H5Lcreate_external(target.c_str(), "/", made.get(), "/away", H5P_DEFAULT, H5P_DEFAULT);
      H5Lcreate_soft("/away/particles/all/position", made.get(), "/particles/all/position",
                     H5P_DEFAULT, H5P_DEFAULT);
    });
    EXPECT_EQ(complaint_about<InputError>(indirect),
              "/particles/all/position: a link that leads out of the file, or to itself: expected "
              "a dataset");
    EXPECT_TRUE(test::contains(describe(indirect), "away"));

    const std::string expected = std::string(positions) +
                                 ": a dataset whose values are in other files: expected them in "
                                 "the file itself";
    const Shape shape{1, 2, 3};
    const Handle space(H5Screate_simple(3, shape.data(), nullptr), H5Sclose, "");
    const auto make_with = [&](const Handle& layout) {
      return make([&](HandMade& made) {
        made.remove(positions);
        H5Dclose(H5Dcreate2(made.get(), positions, H5T_IEEE_F64LE, space.get(), H5P_DEFAULT,
                            layout.get(), H5P_DEFAULT));
      });
    };
    const Handle is_virtual(H5Pcreate(H5P_DATASET_CREATE), H5Pclose, "");
    H5Pset_virtual(is_virtual.get(), space.get(), target.c_str(), positions, space.get());
    EXPECT_EQ(complaint_about<InputError>(make_with(is_virtual)), expected);
    const Handle external(H5Pcreate(H5P_DATASET_CREATE), H5Pclose, "");
    H5Pset_external(external.get(), target.c_str(), 0, H5F_UNLIMITED);
    EXPECT_EQ(complaint_about<InputError>(make_with(external)), expected);
  }
}

TEST_F(Hostile, FiltersThatNeedAPluginAreNamed) {
  const std::string path = make([&](HandMade& made) {
    const Shape shape{1, 2, 3};
    made.remove(positions);
    const Handle space(H5Screate_simple(3, shape.data(), nullptr), H5Sclose, "");
    const Handle layout(H5Pcreate(H5P_DATASET_CREATE), H5Pclose, "");
    H5Pset_chunk(layout.get(), 3, shape.data());
    H5Pset_filter(layout.get(), 32008, H5Z_FLAG_OPTIONAL, 0, nullptr);
    H5Dclose(H5Dcreate2(made.get(), positions, H5T_IEEE_F64LE, space.get(), H5P_DEFAULT,
                        layout.get(), H5P_DEFAULT));
  });
  EXPECT_EQ(complaint_about<InputError>(path),
            std::string(positions) +
                ": stored with filter 32008 of HDF5, for which a plugin would be needed: expected "
                "gzip or another filter that HDF5 itself has (h5repack can change it)");
}

TEST_F(Hostile, PluginsStayOffWhileAFileIsReadAndNoLonger) {
  unsigned before = 0, during = 1, after = 0;
  H5PLget_loading_state(&before);
  {
    const hdf5::Session session;
    H5PLget_loading_state(&during);
  }
  H5PLget_loading_state(&after);
  EXPECT_EQ(during, 0u);
  EXPECT_EQ(after, before);
}

TEST_F(Hostile, CircularLinksEnd) {
  const std::string path = make([&](HandMade& made) {
    for (const char* name : {"/a", "/b", "/c", "/d", "/e", "/f", "/g", "/h", "/i", "/j"}) {
      H5Lcreate_hard(made.get(), "/", made.get(), name, H5P_DEFAULT, H5P_DEFAULT);
    }
    H5Lcreate_soft("/k", made.get(), "/k", H5P_DEFAULT, H5P_DEFAULT);
    H5Lcreate_soft("/m", made.get(), "/l", H5P_DEFAULT, H5P_DEFAULT);
    H5Lcreate_soft("/l", made.get(), "/m", H5P_DEFAULT, H5P_DEFAULT);
  });
  EXPECT_LT(describe(path).size(), 10000u);
  EXPECT_EQ(read_last_frame(path).size(), 2u);
}

TEST_F(Hostile, WhatIsNoFileIsRefusedAtOnce) {
  const std::string pipe = file("pipe"), sparse = file("sparse.h5");
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  for (const std::string& path : {pipe, folder_.string(), std::string("/dev/zero")}) {
    for (const std::string& verdict : verdicts(path)) EXPECT_NE(verdict, "read");
  }
  write_bytes(sparse, "");
  std::filesystem::resize_file(sparse, std::uintmax_t{10} << 30);
  for (const std::string& verdict : verdicts(sparse)) {
    EXPECT_EQ(verdict, sparse + ": not an HDF5 file");
  }
}

}  // namespace
}  // namespace needlework::io
