#include "src/runs/checkpoint.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string_view>
#include <system_error>
#include <utility>

#include "needlework/error.h"
#include "src/io/system_calls.h"
#include "src/machine/descriptors.h"
#include "src/machine/stop_request.h"
#include "src/runs/checksum.h"
#include "src/runs/durable_file.h"
#include "src/scene/printable.h"
#include "src/scene/saved_scene.h"
#include "src/scene/validity.h"
#include "src/trajectory/saved_totals.h"

namespace needlework {

void transfer(Archive& archive, Checkpoint& checkpoint) { archive(checkpoint.bytes); }

void transfer(Archive& archive, UserData& data) {
  bool json = data.kind == UserData::Kind::json;
  archive(json, data.bytes);
  data.kind = json ? UserData::Kind::json : UserData::Kind::bytes;
}

namespace io {
void transfer(Archive& archive, Writer::Position& position) {
  archive(position.frames, position.samples, position.events, position.velocities_set,
          position.data, position.data_bytes);
}
}  // namespace io

}  // namespace needlework

namespace needlework::runs {

static void transfer(Archive& archive, RunFailure& failure) {
  auto& [message, needles, time, collisions, trajectory_hash, version] = failure;
  archive(message, needles, time, collisions, trajectory_hash, version);
}

namespace {

// The first line. Its number is to be changed whenever what is saved changes, here or in any
// function `transfer`. The version is there because the trajectory may change without that, which
// patch versions leave as it is.
constexpr std::string_view mark = "needlework checkpoint 11 of " NEEDLEWORK_VERSION "\n";
// What it has in common with those of other patch versions.
constexpr std::string_view mark_but_patch = mark.substr(0, mark.rfind('.') + 1);

constexpr std::string_view checkpoint_ending = ".checkpoint";
constexpr std::string_view older_ending = ".old";

// Follows the first line.
struct Header {
  std::uint64_t size = 0;      // of what follows the header
  std::uint64_t checksum = 0;  // of the same
};

void transfer(Archive& archive, RunCheckpoint& run) {
  archive(run.scene, run.drawn, run.initial, run.simulation, run.output, run.observation,
          run.velocities_set, run.data, run.failure);
  archive.require(!run.velocities_set ||
                  (std::isfinite(*run.velocities_set) && *run.velocities_set >= 0));
}

InputError damaged(const std::string& path, std::string_view how) {
  return InputError(fmt::format("{}: damaged: {}", path, how));
}

IoError unreadable(const std::string& path, int error) {
  return IoError(
      fmt::format("{}: cannot be read: {}", path, std::generic_category().message(error)));
}

struct Closes {
  void operator()(std::FILE* file) const { std::fclose(file); }
};
using File = std::unique_ptr<std::FILE, Closes>;

// Null if there is no such file.
File open_file(const std::string& path) {
  // Not waiting for a program that would write to a pipe.
  const int descriptor = open_descriptor(path, O_RDONLY | O_NONBLOCK);
  if (descriptor < 0 && errno == ENOENT) return nullptr;
  if (descriptor < 0) throw unreadable(path, errno);
  File file(fdopen(descriptor, "rb"));
  if (!file) {
    const int error = errno;
    close(descriptor);
    throw unreadable(path, error);
  }
  return file;
}

// Reads the next `size` bytes.
std::string read_bytes(std::FILE* file, std::size_t size, const std::string& path) {
  constexpr std::size_t at_once = std::size_t{1} << 26;
  std::string bytes(size, '\0');
  std::size_t done = 0;
  while (done < size) {
    StopRequest::check();
    const std::size_t wanted = std::min(size - done, at_once);
    const std::size_t got = std::fread(bytes.data() + done, 1, wanted, file);
    done += got;
    if (got < wanted) break;
  }
  bytes.resize(done);
  if (std::ferror(file)) throw unreadable(path, errno);
  return bytes;
}

std::string read_line(std::FILE* file, const std::string& path) {
  constexpr std::size_t longest = 100;
  std::string line;
  while (line.size() < longest && !line.ends_with('\n')) {
    const std::string next = read_bytes(file, 1, path);
    if (next.empty()) break;
    line += next;
  }
  return line;
}

void require_mark(const std::string& path, std::string_view line) {
  if (line.starts_with(mark_but_patch) && line.ends_with('\n')) {
    const std::string_view patch = line.substr(mark_but_patch.size());
    if (patch.size() > 1 && patch.find_first_not_of("0123456789") == patch.size() - 1) return;
  }
  constexpr std::string_view hdf5 = "\x89HDF\r\n", ending = ".checkpoint";
  if (line == hdf5 && !path.ends_with(ending)) {
    throw InputError(fmt::format("{}: a file of HDF5, not a checkpoint: expected such as {}{}",
                                 path, path, ending));
  }
  constexpr std::string_view any_version = "needlework checkpoint ";
  if (!line.starts_with(any_version)) throw damaged(path, "expected a checkpoint");
  const auto quoted = [](std::string_view text) {
    return printable(text.substr(0, text.find('\n')));
  };
  throw InputError(fmt::format(
      "{}: \"{}\": expected \"{}*\": a run is continued by versions with the same major and minor "
      "number as the one that began it; a new run starts from its last frame by initial.file",
      path, quoted(line), quoted(mark_but_patch)));
}

// A checksum says nothing about a file that somebody has made.
void validate(Scene& scene) {
  // The name of the output file may be any: options give it, and callers replace it.
  std::string file = std::exchange(scene.output.file, {});
  require_restored(scene);
  scene.output.file = std::move(file);
  // They become parts of messages.
  for (auto& [key, place] : scene.places) place = printable(place);
}

// A checkpoint that has been read up to its content.
struct OpenCheckpoint {
  File file;
  Header header;
  std::uint64_t size;  // of the content, by that of the file
};

// None if there is no such file.
std::optional<OpenCheckpoint> open_checkpoint(const std::string& path) {
  File file = open_file(path);
  if (!file) return std::nullopt;
  struct stat status;
  if (fstat(fileno(file.get()), &status) != 0) throw unreadable(path, errno);
  if (!S_ISREG(status.st_mode)) throw InputError(path + ": expected an ordinary file");
  const std::string line = read_line(file.get(), path);
  require_mark(path, line);
  Header header;
  const std::string head = read_bytes(file.get(), sizeof header, path);
  const auto size = static_cast<std::uint64_t>(status.st_size);
  const std::uint64_t begin = line.size() + sizeof header;
  if (head.size() < sizeof header || size < begin) throw damaged(path, "it is cut short");
  std::memcpy(&header, head.data(), sizeof header);
  return OpenCheckpoint{std::move(file), header, size - begin};
}

// None if there is no such file.
std::optional<RunCheckpoint> read_if_present(const std::string& path) {
  const auto opened = open_checkpoint(path);
  if (!opened) return std::nullopt;
  const auto& [file, header, size] = *opened;
  // Before memory is taken for it.
  if (size != header.size) {
    throw damaged(path, fmt::format("{} bytes: expected {}", size, header.size));
  }
  const std::string bytes = read_bytes(file.get(), size, path);
  if (bytes.size() != size || checksum_of(bytes) != header.checksum) {
    throw damaged(path, "its checksum is wrong");
  }
  RunCheckpoint out;
  try {
    Archive archive = Archive::from(bytes);
    transfer(archive, out);
    archive.require_end();
    validate(out.scene);
    for (const auto& [name, data] : out.data) require_valid_data(name, data);
  } catch (const InputError& error) {
    throw damaged(path, error.what());
  }
  out.origin = {.path = path, .checksum = header.checksum};
  return out;
}

std::string bytes_of(const RunCheckpoint& checkpoint) {
  std::string bytes;
  bytes.reserve(checkpoint.simulation.bytes.size() + checkpoint.observation.size() +
                checkpoint.scene.text.size() + 65536);
  bytes = mark;
  bytes.resize(mark.size() + sizeof(Header));
  Archive archive = Archive::to(bytes);
  // An archive that writes changes nothing.
  transfer(archive, const_cast<RunCheckpoint&>(checkpoint));
  const std::string_view content = std::string_view(bytes).substr(mark.size() + sizeof(Header));
  const Header header{content.size(), checksum_of(content)};
  std::memcpy(bytes.data() + mark.size(), &header, sizeof header);
  return bytes;
}

std::string unfinished(const std::string& path) { return path + ".part"; }

// Whether this is the older of two, and the newest is whole. It was damaged or missing when the
// older one was chosen.
bool has_newer_one(const std::string& path) {
  if (!path.ends_with(older_ending)) return false;
  try {
    return read_if_present(path.substr(0, path.size() - older_ending.size())).has_value();
  } catch (const std::runtime_error&) {  // InputError or IoError
    return false;
  }
}

void move_if_present(const std::string& from, const std::string& to) {
  if (std::rename(from.c_str(), to.c_str()) == 0 || errno == ENOENT) return;
  throw IoError(fmt::format("{}: {}", to, std::generic_category().message(errno)));
}

// The ordinary file to which a symbolic link leads, or else the name itself.
std::string behind_links(const std::string& path) {
  std::error_code error;
  if (!std::filesystem::is_symlink(path, error)) return path;
  if (!std::filesystem::is_regular_file(path, error)) return path;
  const std::filesystem::path file = std::filesystem::canonical(path, error);
  return error ? path : file.string();
}

// Of a run's file whose checkpoint is missing.
[[noreturn]] void fail_without(const std::string& checkpoint) {
  const std::string file = checkpoint.substr(0, checkpoint.size() - checkpoint_ending.size());
  std::error_code error;
  if (!std::filesystem::exists(file, error)) {
    throw unreadable(file, error ? error.value() : ENOENT);
  }
  const bool is_checkpoint = file.ends_with(checkpoint_ending);
  const std::string hint = is_checkpoint
                               ? fmt::format("; expected the file of the run, {}",
                                             file.substr(0, file.size() - checkpoint_ending.size()))
                               : "";
  throw InputError(
      fmt::format("{}: missing: expected the checkpoint of a run; there is nothing to continue{}",
                  checkpoint, hint));
}

}  // namespace

RunCheckpoint CheckpointFiles::read(const std::string& path) {
  if (auto checkpoint = read_if_present(path)) return *std::move(checkpoint);
  throw InputError(path + ": missing: expected the checkpoint or the bundle of a run");
}

CheckpointFiles::CheckpointFiles(const std::string& output_file)
    : newest_(behind_links(output_file) + std::string(checkpoint_ending)),
      older_(newest_ + std::string(older_ending)),
      bundle_(behind_links(output_file) + ".failure") {}

bool CheckpointFiles::exist() const {
  const auto may_exist = [](const std::string& path) {
    std::error_code ignored;
    return std::filesystem::status(path, ignored).type() != std::filesystem::file_type::not_found;
  };
  return may_exist(newest_) || may_exist(older_);
}

void CheckpointFiles::require_writable() const {
  write_durably(unfinished(newest_), "");
  std::error_code ignored;
  std::filesystem::remove(unfinished(newest_), ignored);
}

void CheckpointFiles::write(const RunCheckpoint& checkpoint, Newest present) {
  write_durably(unfinished(newest_), bytes_of(checkpoint));
  if (present == Newest::becomes_older) move_if_present(newest_, older_);
  rename_durably(unfinished(newest_), newest_);
}

void CheckpointFiles::write_bundle(const RunCheckpoint& checkpoint) {
  replace_durably(bundle_, bytes_of(checkpoint));
}

void CheckpointFiles::move_bundle(const std::string& output_file) const {
  move_if_present(bundle_, CheckpointFiles(output_file).bundle_);
}

CheckpointFiles::Latest CheckpointFiles::latest() const {
  try {
    if (auto newest = read_if_present(newest_)) return {*std::move(newest), {}};
  } catch (const std::runtime_error& error) {  // InputError or IoError
    try {
      if (auto older = read_if_present(older_)) {
        older->origin.instead_of_newest = true;
        return {*std::move(older), fmt::format("{}; continuing from {}", error.what(), older_)};
      }
    } catch (const InputError&) {
      // What is wrong with the newest says more.
    }
    throw;
  }
  // The program was stopped between two renames.
  if (auto older = read_if_present(older_)) return {*std::move(older), {}};
  fail_without(newest_);
}

void CheckpointFiles::require_unchanged(const RunCheckpoint::Origin& origin) {
  try {
    const auto now = open_checkpoint(origin.path);
    const bool unchanged = now && now->header.checksum == origin.checksum;
    if (unchanged && !has_newer_one(origin.path)) return;
  } catch (const InputError&) {
    // It is another one, or gone.
  }
  throw IoError(origin.path + ": another program has continued the run in the meantime");
}

void CheckpointFiles::remove() {
  for (const std::string& path : {newest_, older_, unfinished(newest_)}) {
    std::error_code error, ignored;
    std::filesystem::remove(path, error);
    if (error && std::filesystem::exists(path, ignored)) {
      throw IoError(fmt::format("{}: cannot be removed: {}", path, error.message()));
    }
  }
  // No run continues from it.
  for (const std::string& path : {bundle_, unfinished(bundle_)}) {
    std::error_code ignored;
    std::filesystem::remove(path, ignored);
  }
}

}  // namespace needlework::runs
