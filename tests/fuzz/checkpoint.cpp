// Fuzz target: a checkpoint with any content and a right checksum continues a run, or is an error.
//
// The input says how the checkpoint of a run is changed, so that inputs stay of use when the form
// of checkpoints changes. Checksum and size are those of the changed content.
#include <array>
#include <boost/crc.hpp>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <limits>

#include "src/runs/load_checkpoint.h"
#include "tests/fuzz/small_run.h"
#include "tests/support/whole_file.h"

using namespace needlework;

namespace {

struct Base {
  std::string output;   // file that the run has written, to be copied
  std::string content;  // of its checkpoint, behind the head
  std::string mark;
};

Base base_of(const std::string& output) {
  const std::string bytes = test::bytes_of(output + ".checkpoint");
  const std::size_t mark = bytes.find('\n') + 1;  // the first line; see src/runs/checkpoint.cpp
  const std::size_t content = mark + 16;          // behind size and checksum
  fuzz::require(bytes.size() > content);
  return {output, bytes.substr(content), bytes.substr(0, mark)};
}

std::string run_plain() {
  const std::string path = fuzz::folder() / "plain.h5";
  fuzz::run_scene(R"(
needles = { count = 3, box = 3 }
engine.threads = 1
until.time = 1
output.file = ")" +
                  path + "\"\n");
  return path;
}

// Ends with needles in contact.
std::string run_sliding() {
  const std::string path = fuzz::folder() / "sliding.h5";
  const SlidingContacts contacts = *fuzz::run_scene(R"(
needles = { count = 12, box = 2.5, seed = 4 }
collisions = { epsilon = 0.3, sliding = true }
engine.threads = 1
until.collisions_per_needle = 20
output.file = ")" + path + "\"\n");
  fuzz::require(contacts.entered >
                contacts.ended_by_force + contacts.ended_by_tip + contacts.ended_by_strike);
  return path;
}

// Overwrites, inserts or removes bytes.
void change(std::string& content, FuzzedDataProvider& data) {
  constexpr std::uint64_t odd[] = {0, 1, 2, 255, 1ull << 31, 1ull << 32, 1ull << 62, ~0ull};
  constexpr double odd_numbers[] = {0,
                                    -1,
                                    1e-300,
                                    1e300,
                                    -1e300,
                                    0.5,
                                    1e-9,
                                    1e9,
                                    std::numeric_limits<double>::infinity(),
                                    std::numeric_limits<double>::quiet_NaN()};
  const auto at = data.ConsumeIntegralInRange<std::size_t>(0, content.size());
  const std::size_t after = content.size() - at;
  const auto overwrite = [&](const auto& value) {
    std::memcpy(content.data() + at, &value, std::min(sizeof value, after));
  };
  switch (data.ConsumeIntegralInRange(0, 6)) {
    case 0:
      return overwrite(data.PickValueInArray(odd));
    case 1:
      return overwrite(data.PickValueInArray(odd_numbers));
    case 2:
      return overwrite(data.ConsumeFloatingPoint<double>());
    case 3:
      return overwrite(data.ConsumeIntegral<std::uint8_t>());
    case 4:
      return overwrite(data.ConsumeIntegral<std::uint32_t>());
    case 5:
      content.insert(at, data.ConsumeRandomLengthString(64));
      return;
    default:
      content.erase(at, data.ConsumeIntegralInRange<std::size_t>(1, 64));
  }
}

void write_checkpoint(const std::string& path, const std::string& mark,
                      const std::string& content) {
  boost::crc_optimal<64, 0x42f0e1eba9ea3693, ~std::uint64_t{0}, ~std::uint64_t{0}, true, true> crc;
  crc.process_bytes(content.data(), content.size());
  const std::uint64_t head[] = {content.size(), crc.checksum()};
  std::string bytes = mark;
  bytes.append(reinterpret_cast<const char*>(head), sizeof head);
  fuzz::write_file(path, bytes + content);
}

void resume_a_little(const std::string& output) {
  auto [saved, warning] = runs::load_checkpoint(output, [](Scene& scene) {
    scene.engine.threads = 1;
    scene.output.checkpoint_every = 0;
  });
  if (saved.scene.needles.count > 100) return;
  try {
    runs::PreparedRun run(std::move(saved));
    Scene::Until until;
    until.collisions_per_needle = 20;
    until.wall_s = 0.1;
    fuzz::Silent silent;
    run.advance(until, silent);
  } catch (const InvalidStateError&) {
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  static const std::array<Base, 3> bases{base_of(run_plain()), base_of(fuzz::run_with_everything()),
                                         base_of(run_sliding())};
  io::set_reads_in_child_process(false);
  FuzzedDataProvider data(bytes, size);
  const Base& base = bases[data.ConsumeIntegralInRange<std::size_t>(0, bases.size() - 1)];
  std::string content = base.content;
  for (int changes = 0; changes < 20 && data.remaining_bytes() > 0; ++changes) {
    change(content, data);
  }
  const std::string output = fuzz::folder() / "input.h5";
  std::filesystem::copy_file(base.output, output,
                             std::filesystem::copy_options::overwrite_existing);
  write_checkpoint(output + ".checkpoint", base.mark, content);
  fuzz::allow_bad_input([&] { resume_a_little(output); });
  return 0;
}
