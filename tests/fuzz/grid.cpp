// Fuzz target: any bytes are the grid of a sweep or an error. What follows a line "====" is the
// base scene that the grid names.
#include <string>

#include "src/runs/sweep_grid.h"
#include "tests/fuzz/target.h"

using namespace needlework;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view all = fuzz::text_of(data, size);
  constexpr std::string_view between = "\n====\n";
  const auto at = std::min(all.find(between), all.size());
  const std::string grid(all.substr(0, at));
  const std::string scene(all.substr(std::min(at + between.size(), all.size())));
  // Large grids differ from small ones in the time that they take alone.
  if (grid.find("count") != grid.npos && grid.find("0000") != grid.npos) return 0;
  fuzz::allow_bad_input([&] {
    const runs::sweep::Grid read = runs::sweep::read_grid(
        "grid", [&](const std::string& path) { return path == "grid" ? grid : scene; });
    fuzz::require(!read.seeds.empty() && read.members.size() == read.points() * read.seeds.size());
    for (const runs::sweep::Member& member : read.members) {
      fuzz::require(!member.name.empty() && member.name.size() < 255);
      fuzz::require(member.name.find('/') == std::string::npos);
      fuzz::require(member.scene.output.file.empty() && member.scene.engine.threads == 1);
    }
  });
  return 0;
}
