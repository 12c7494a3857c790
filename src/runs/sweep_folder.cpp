#include "src/runs/sweep_folder.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <system_error>
#include <utility>

#include "needlework/error.h"
#include "src/io/atomic_file.h"
#include "src/io/write_lock.h"
#include "src/machine/descriptors.h"
#include "src/runs/checkpoint.h"
#include "src/runs/durable_file.h"

namespace needlework::runs {
namespace {

namespace fs = std::filesystem;

std::string reason(int error) { return std::generic_category().message(error); }

// The grid as the folder remembers it.
std::string record_of(const sweep::Grid& grid) {
  std::string record = "# The grid of this folder, by needlework " NEEDLEWORK_VERSION ".\n";
  record += grid.text + "\n# Its base scene:\n";
  std::istringstream lines(grid.base);
  for (std::string line; std::getline(lines, line);) record += "# " + line + "\n";
  return record;
}

void make_folder(const std::string& path, const std::string& place) {
  std::error_code error;
  fs::create_directories(path, error);
  if (!fs::is_directory(path)) {
    throw IoError(fmt::format("{}: cannot be made: {}", place,
                              error ? error.message() : std::string("expected a folder")));
  }
  if (access(path.c_str(), W_OK | X_OK) != 0) {
    throw IoError(place + ": expected permission to write there");
  }
}

std::optional<std::string> contents(const std::string& path) {
  const StandardDescriptors occupied;
  std::ifstream file(path, std::ios::binary);
  if (!file) return std::nullopt;
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

void write_record(const std::string& path, const std::string& record) {
  io::AtomicFile atomic(path, true);
  const StandardDescriptors occupied;
  std::ofstream file(atomic.temporary(), std::ios::binary);
  file << record;
  file.close();
  if (!file) throw IoError(path + ": cannot be written");
  atomic.publish();
}

}  // namespace

SweepFolder::SweepFolder(std::string path, const sweep::Grid& grid, bool force,
                         const std::string& place)
    : path_(std::move(path)), force_(force) {
  make_folder(path_, place);
  const std::string file = path_ + "/grid.toml";
  const std::string record = record_of(grid);
  const auto present = contents(file);
  if (present == record) return;
  if (present && !force_) {
    throw InputError(
        fmt::format("{}: is of another grid, scene or version ({}): expected a new folder, or "
                    "--force to continue in this one",
                    place, file));
  }
  write_record(file, record);
}

SweepFolder::State SweepFolder::state(const sweep::Member& member) const {
  if (matching_run(path_ + "/" + member.name + ".h5", member, false)) return State::finished;
  if (matching_run(failed_file(member), member, false)) return State::failed;
  return State::missing;
}

std::optional<io::RecordedRun> SweepFolder::finished_run(const sweep::Member& member) const {
  return matching_run(path_ + "/" + member.name + ".h5", member, true);
}

std::optional<io::RecordedRun> SweepFolder::matching_run(const std::string& file,
                                                         const sweep::Member& member,
                                                         bool with_series) const {
  if (access(file.c_str(), F_OK) != 0) return std::nullopt;
  std::string difference = "its scene or version is another";
  try {
    io::RecordedRun run = io::read_run(file, with_series);
    if (run.scene == member.scene.text && run.version == NEEDLEWORK_VERSION) return run;
  } catch (const InputError& error) {
    difference = error.what();
  } catch (const IoError& error) {
    difference = error.what();
  }
  if (force_) return std::nullopt;
  throw InputError(fmt::format(
      "{}: expected a member of this grid, or --force to replace the file: {}", file, difference));
}

std::string SweepFolder::warning() const {
  return io::warning_without_locks(path_ + "/grid.toml", path_);
}

std::string SweepFolder::unfinished_file(const sweep::Member& member) const {
  return path_ + "/" + member.name + ".h5.part";
}

std::string SweepFolder::failed_file(const sweep::Member& member) const {
  return path_ + "/" + member.name + ".failed.h5";
}

void SweepFolder::keep(const sweep::Member& member, State as) const {
  const std::string from = unfinished_file(member);
  const std::string to =
      as == State::failed ? failed_file(member) : path_ + "/" + member.name + ".h5";
  // The checkpoints, from which it could be made again, are removed only when it is on the disk.
  sync_bytes(from);
  rename_durably(from, to);
  CheckpointFiles(from).move_bundle(to);
  CheckpointFiles(from).remove();
}

void SweepFolder::remove_unfinished(const sweep::Member& member) const {
  unlink(unfinished_file(member).c_str());
  CheckpointFiles(unfinished_file(member)).remove();
}

std::string SweepFolder::lock_file(const sweep::Member& member) const {
  return path_ + "/" + member.name + ".lock";
}

// The file goes when its claim does, and others may have opened it just before. So what counts is
// the lock of the file that has the name.
Claim::Claim(const SweepFolder& folder, const sweep::Member& member)
    : path_(folder.lock_file(member)) {
  for (;;) {
    descriptor_ = open_descriptor(path_, O_CREAT | O_RDWR);
    if (descriptor_ < 0) throw IoError(path_ + ": " + reason(errno));
    // A file system without locks cannot exclude other processes: see SweepFolder::warning().
    const bool taken = !io::locks_turned_off() && flock(descriptor_, LOCK_EX | LOCK_NB) != 0 &&
                       errno == EWOULDBLOCK;
    struct stat locked, named;
    const bool current = !taken && fstat(descriptor_, &locked) == 0 &&
                         stat(path_.c_str(), &named) == 0 && locked.st_ino == named.st_ino;
    if (current) return;
    close(std::exchange(descriptor_, -1));
    if (taken) return;
  }
}

Claim::~Claim() {
  if (!granted()) return;
  unlink(path_.c_str());
  close(descriptor_);
}

}  // namespace needlework::runs
