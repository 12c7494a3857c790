// Reading a file while another process writes it.
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <cstdio>
#include <map>
#include <stdexcept>

#include "src/io/source.h"
#include "tests/io/support.h"

namespace needlework::io {
namespace {

// A process that writes frames and samples to a file for a minute, and flushes after each.
class WritingProcess {
 public:
  explicit WritingProcess(const std::string& path) : process_(fork()) {
    if (process_ < 0) throw std::runtime_error("no process can be made");
    if (process_ > 0) return;
    alarm(60);
    try {
      write(path);
    } catch (const std::exception& error) {
      std::fprintf(stderr, "%s\n", error.what());
    }
    _exit(1);
  }
  ~WritingProcess() {
    kill(process_, SIGKILL);
    waitpid(process_, nullptr, 0);
  }
  WritingProcess(const WritingProcess&) = delete;
  WritingProcess& operator=(const WritingProcess&) = delete;

  bool has_ended() const { return waitpid(process_, nullptr, WNOHANG) != 0; }

 private:
  [[noreturn]] static void write(const std::string& path) {
    const State state = make_state(2);
    Writer writer(path, true, make_scene(2, true), {});
    for (int row = 0;; ++row) {
      writer.write_frame(make_totals(row), state);
      writer.write_series(make_totals(row));
      writer.write_event(Happening{});
      writer.flush();
    }
  }

  pid_t process_;
};

// Of the metadata that a reader needs, HDF5 keeps a small part.
void limit_cache(const Source& source, std::size_t bytes) {
  H5AC_cache_config_t config{};
  config.version = H5AC__CURR_CACHE_CONFIG_VERSION;
  hdf5::check(H5Fget_mdc_config(source.get(), &config), source.path());
  config.set_initial_size = true;
  config.initial_size = config.min_size = config.max_size = bytes;
  config.incr_mode = H5C_incr__off;
  config.flash_incr_mode = H5C_flash_incr__off;
  config.decr_mode = H5C_decr__off;
  hdf5::check(H5Fset_mdc_config(source.get(), &config), source.path());
}

class Growing : public InFolder {};

TEST_F(Growing, ASourceKeepsTheRowsOfItsOpening) {
  const WritingProcess process(file("a.h5"));
  while (!std::filesystem::exists(file("a.h5"))) {
    ASSERT_FALSE(process.has_ended());
    usleep(1000);
  }
  hsize_t first = 0, last = 0;
  for (int round = 0; round < 40 || (last <= first + 100 && round < 4000); ++round) {
    const Source source(file("a.h5"));
    limit_cache(source, std::size_t{1024} << round % 8);
    const hsize_t events = Element(source, "/events/time").rows();
    for (const std::string name : {"/events/arms", "/events/shift"}) {
      ASSERT_GE(Element(source, name).rows(), events) << name;
    }
    std::map<std::string, std::vector<std::int64_t>> steps;
    for (int reading = 0; reading < 4; ++reading) {
      for (const std::string name :
           {"/particles/needles/position", "/series/energy", "/particles/needles/velocity",
            "/observables/energy", "/series/momentum"}) {
        const Element element(source, name);
        ASSERT_EQ(element.rows(), element.steps()->size());
        for (hsize_t row = 0; row < element.rows(); ++row) {
          ASSERT_EQ((*element.steps())[row], make_totals(static_cast<int>(row)).collisions) << name;
        }
        const std::vector<std::int64_t>& before =
            steps.try_emplace(name, *element.steps()).first->second;
        ASSERT_EQ(before.size(), element.rows()) << name << " at reading " << reading;
        if (element.rows() > 0) element.read<double>(element.rows() - 1);
      }
    }
    const hsize_t rows = steps.at("/series/energy").size();
    ASSERT_GE(rows, last);
    if (round == 0) first = rows;
    last = rows;
  }
  EXPECT_GT(last, first + 100);
}

}  // namespace
}  // namespace needlework::io
