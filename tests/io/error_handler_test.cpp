// A host program that handles errors of HDF5 in its own way is not affected by this library.
#include <string>

#include "src/io/vtkhdf.h"
#include "tests/io/support.h"

namespace needlework::io {
namespace {

// What the host's error handler has seen.
struct HostData {
  int calls = 0;
};

herr_t count_call(hid_t, void* data) {
  ++static_cast<HostData*>(data)->calls;
  return 0;
}

herr_t count_call_v1(void* data) { return count_call(H5E_DEFAULT, data); }

// A call of the host itself that fails.
void fail_as_host() { EXPECT_LT(H5Fopen("no such file", H5F_ACC_RDONLY, H5P_DEFAULT), 0); }

// The host sets a handler of either kind at its start; the one that HDF5 had returns at its end.
class HostProgram : public InFolder {
 protected:
  HostProgram() { H5Eget_auto2(H5E_DEFAULT, &before_, &data_before_); }
  ~HostProgram() override { H5Eset_auto2(H5E_DEFAULT, before_, data_before_); }

  void set_handler() { H5Eset_auto2(H5E_DEFAULT, count_call, &host_); }

  void expect_own_handler() {
    H5E_auto2_t handler = nullptr;
    void* data = nullptr;
    EXPECT_GE(H5Eget_auto2(H5E_DEFAULT, &handler, &data), 0);
    EXPECT_EQ(handler, count_call);
    EXPECT_EQ(data, &host_);
    EXPECT_EQ(host_.calls, 0);
  }

  void use_with_success() {
    Writer writer(file("run.h5"), true, make_scene(3, true), {});
    for (int frame = 0; frame < 2; ++frame) {
      writer.write_frame(make_totals(frame), make_state(3));
      writer.write_series(make_totals(frame));
      writer.write_event(Collision());
      writer.flush();
    }
    writer.close();
    write_vtkhdf(file("run.vtkhdf"), true, read_last_frame(file("run.h5")));
    EXPECT_EQ(read_run(file("run.h5")).series.size(), 2u);
    EXPECT_FALSE(describe(file("run.h5")).empty());
  }

  void use_with_failure() {
    const std::string path = file("cut.h5");
    std::filesystem::copy_file(file("run.h5"), path);
    std::filesystem::resize_file(path, std::filesystem::file_size(path) / 2);
    EXPECT_THROW(read_last_frame(path), IoError);
    EXPECT_THROW(read_run(path), IoError);
    EXPECT_THROW(describe(path), IoError);
    EXPECT_THROW(read_run(file("run.vtkhdf")), InputError);
    EXPECT_THROW(read_last_frame(file("none.h5")), IoError);
    EXPECT_THROW(Writer(file("none/run.h5"), true, make_scene(3), {}), IoError);
    // HDF5 refuses chunks of 2^32 rows or more, after the file was created.
    EXPECT_THROW(Writer(path, true, make_scene(std::uint64_t{1} << 40), {}), IoError);
    std::filesystem::remove(path);
  }

  HostData host_;

 private:
  H5E_auto2_t before_ = nullptr;
  void* data_before_ = nullptr;
};

TEST_F(HostProgram, KeepsItsErrorHandlerWhileAWriterIsOpen) {
  set_handler();
  Writer writer(file("open.h5"), false, make_scene(3), {});
  writer.write_frame(make_totals(0), make_state(3));
  expect_own_handler();
  fail_as_host();
  EXPECT_EQ(host_.calls, 1);
  writer.close();
  expect_same(make_state(3), read_last_frame(file("open.h5")));
}

TEST_F(HostProgram, KeepsAnErrorHandlerOfTheOlderKind) {
  H5Eset_auto1(count_call_v1, &host_);
  use_with_success();
  use_with_failure();
  unsigned is_v2 = 1;
  H5Eauto_is_v2(H5E_DEFAULT, &is_v2);
  EXPECT_EQ(is_v2, 0u);
  H5E_auto1_t handler = nullptr;
  void* data = nullptr;
  H5Eget_auto1(&handler, &data);
  EXPECT_EQ(handler, count_call_v1);
  EXPECT_EQ(data, &host_);
  EXPECT_EQ(host_.calls, 0);
  fail_as_host();
  EXPECT_EQ(host_.calls, 1);
}

TEST_F(HostProgram, KeepsTheErrorsOnItsStack) {
  set_handler();
  fail_as_host();
  const ssize_t errors = H5Eget_num(H5E_DEFAULT);
  ASSERT_GT(errors, 0);
  use_with_success();
  EXPECT_EQ(H5Eget_num(H5E_DEFAULT), errors);
  use_with_failure();
  EXPECT_EQ(H5Eget_num(H5E_DEFAULT), errors);
  host_.calls = 0;
  expect_own_handler();
}

TEST_F(HostProgram, HasAnEmptyErrorStackAfterOurFailures) {
  set_handler();
  H5Eclear2(H5E_DEFAULT);
  use_with_success();
  use_with_failure();
  EXPECT_EQ(H5Eget_num(H5E_DEFAULT), 0);
}

}  // namespace
}  // namespace needlework::io
