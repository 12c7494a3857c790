// Fuzz target: an HDF5 file with any content is a run or a sweep that can be shown, or an error.
#include <array>
#include <nlohmann/json.hpp>

#include "needlework/h5md.h"
#include "src/io/contents.h"
#include "src/report/arrays.h"
#include "src/report/run_section.h"
#include "src/report/sweep_section.h"
#include "src/report/thinning.h"
#include "tests/fuzz/edited_hdf5.h"
#include "tests/fuzz/small_run.h"
#include "tests/fuzz/target.h"

using namespace needlework;

namespace {

void show(const std::string& path) {
  const io::Contents contents(path);
  report::Arrays arrays;
  const bool sweep = contents.has("/sweep/grid");
  const auto page = sweep ? report::sweep_section(path, contents, {}, arrays)
                          : report::run_section(path, contents, {}, arrays);
  fuzz::require(!page.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace).empty());
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  static const fuzz::BaseFile base(fuzz::run_with_everything());
  io::set_reads_in_child_process(false);
  FuzzedDataProvider data(bytes, size);
  const std::string path = fuzz::folder() / "input.h5";
  base.edit(path, data);
  fuzz::allow_bad_input([&] { io::describe(path); });
  fuzz::allow_bad_input([&] { io::read_run(path); });
  fuzz::allow_bad_input([&] { show(path); });
  return 0;
}
