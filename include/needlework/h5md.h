// H5MD 1.1 files: writes runs, and reads initial states and finished runs.
//
// docs/file-format.md describes each dataset of a file that a Writer writes. F frames, S samples,
// E events and N needles are stored as follows:
//
//   /h5md                 version [1, 1], author, creator
//   /parameters           scene, title, version, seed, isa, accuracy, threads, epoch_length, k,
//                         epsilon, beta
//   /particles/needles    box/edges [F][3][3]; position, velocity, image, orientation and
//                         angular_velocity, each [F][N][3]; id [N], mass [N]
//   /observables          the sums of Totals, each [F]; momentum [F][3]
//   /series               the same sums, each [S] or [S][3], and in a group for each observable of
//                         the scene its fields, each [S][...]
//   /velocities_set       where a caller has replaced all velocities: step, time, each [C]; t_tr,
//                         t_rot, energy, each [C][2], and momentum [C][2][3], before and after
//   /user_data            a user's own data in the order in which they were set: step, time, name,
//                         json, begin, size, each [D]; bytes [B]
//   /events               time, epoch, offset, normal_velocity, tc, each [E]; pair, arms, each
//                         [E][2]; shift, impulse, each [E][3]; see Collision; and, if there are
//                         other events than collisions of two needles, kind [E]; see Happening
//
// A quantity that depends on time is an H5MD element: a group with the datasets value, step (number
// of collisions so far) and time. All elements that belong to frames share one step and one time,
// and the elements of /series share another pair. /observables has one row for each frame, because
// readers of H5MD such as MDAnalysis expect that; samples at other times are in /series.
//
// The functions and classes of this header may be used by several threads; their calls of HDF5
// exclude each other. They cannot exclude other code of the process that calls HDF5. They leave the
// HDF5 error handler and error stack of the caller as they were.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "needlework/happening.h"
#include "needlework/scene.h"
#include "needlework/series.h"
#include "needlework/state.h"
#include "needlework/totals.h"
#include "needlework/user_data.h"

namespace needlework::io {

/// Properties of a run that a file records besides the scene.
struct RunInfo {
  std::string isa;                       ///< name of the instruction set in use, never "auto"
  int threads = 1;                       ///< threads in use
  double epoch_length = 0;               ///< length of the epochs in /events [time]
  std::string accuracy = "standard";     ///< level in use, and the settings that differ from it
  std::vector<SeriesGroup> series = {};  ///< what /series holds besides the totals
  std::vector<std::uint32_t> ids = {};   ///< of needles in each frame, for Writer::resume(), which
                                         ///< compares them if there are any
  std::vector<std::uint8_t> species = {};  ///< of needles in each frame; empty: all of the first
  OwnBodies own_bodies = {};               ///< of the same needles, where those of a species differ
  /// Names in /parameters of what is assumed of the bodies, and not known.
  std::vector<std::string> assumed = {};
  bool has_kinds = false;  ///< whether /events holds more than collisions of two needles
};

/// Writes one run to one file.
///
/// Everything written before the last flush() stays readable when the program ends at any moment,
/// by kill -9 or because the disk is full, and everything before the last sync() is on the disk.
/// What a power failure leaves of a file to which more was written since then depends on the file
/// system. HDF5 1.10 and later can open the file for reading at any time: while it is written, also
/// by resume(), after the program was killed, and after it was closed. In the first two cases a
/// dataset may have rows that are not complete yet; the complete rows are those for which `step`
/// has an entry. No other program can open the file for writing, on file systems with locks.
///
/// All members throw IoError, "PATH: reason" in one line, when the file cannot be written, and on
/// every later use. They throw std::logic_error when they are used wrongly.
class Writer {
 public:
  /// How much of a run is in a file.
  struct Position {
    std::uint64_t frames = 0, samples = 0, events = 0;  ///< complete rows
    std::uint64_t velocities_set = 0, data = 0;         ///< the same
    std::uint64_t data_bytes = 0;                       ///< of the values of user data
    friend bool operator==(const Position&, const Position&) = default;
  };

  /// Creates the file under a temporary name in the same folder, and renames it when it has all
  /// groups and datasets. An existing file is replaced if `force` is true and is an IoError
  /// otherwise; a directory or a device is always an IoError. scene.needles.count must be the
  /// number of needles of all frames, also when the scene takes its initial state from a file.
  /// /events exists if scene.output.events is true.
  Writer(const std::string& path, bool force, const Scene& scene, const RunInfo& run);
  /// Continues a file that a Writer of the same scene and run wrote, whether that was closed, was
  /// killed or failed, and also in this way itself. Rows from `position` on are removed, after
  /// which the file is what the Writer had written at that position. At any moment of the removal
  /// the file can be read, and the rows before `position` are complete.
  ///
  /// `isa` and `threads` of the run may be other ones; the file keeps those it has. Throws IoError
  /// if the file cannot be opened for writing, or is open for writing in another program, and
  /// InputError, "PATH: /DATASET...: expected ...", if it is not a file of this scene and run or
  /// has fewer rows than `position`. In both cases the file is as it was. `approve` is called when
  /// no other program can write the file any more, and before anything is changed; it may throw.
  static Writer resume(const std::string& path, const Scene& scene, const RunInfo& run,
                       const Position& position, const std::function<void()>& approve = {});
  Writer(Writer&&) noexcept;
  Writer& operator=(Writer&&) noexcept;
  ~Writer();

  /// Appends a sample to each element of /series. `values` are the rows of the fields of
  /// RunInfo::series, one after the other, without constants.
  void write_series(const Totals& totals, std::span<const double> values = {});
  /// Appends a frame to /particles/needles, and the totals at its time to /observables. Images are
  /// written as zeros if the state has none. All frames must have the same ids in the same order.
  void write_frame(const Totals& totals, const State& state);
  /// Appends what has happened to /events. Events are kept in memory and written in blocks of a
  /// few thousand. Only with RunInfo::has_kinds may it be something else than a collision.
  void write_event(const Happening& happening);
  void write_event(const Collision& collision) {
    write_event(Happening{Happening::pair, 0, collision});
  }
  /// Appends to /velocities_set that all velocities have been replaced: the totals at that instant,
  /// before and after.
  void write_velocities_set(const Totals& before, const Totals& after);
  /// Appends to /user_data, at this instant, the new value of a name; nullptr: it has none from now
  /// on. Throws InputError as require_valid_data() does.
  void write_data(const Totals& now, const std::string& name, const UserData* data);
  /// Writes everything that is still in memory to the file. The operating system may keep that in
  /// its own memory for a while, which a killed program does not lose, but a power failure does.
  void flush();
  /// Flushes, and returns when the file and its name are on the disk. What is written afterwards
  /// to another file may therefore refer to position().
  void sync();
  /// Throws IoError if nothing more can be written: after a failed write, or in a forked child.
  void require_writable();
  /// The rows given to this writer, with those that were in a resumed file. They are complete in
  /// the file after a flush().
  Position position() const;
  /// Flushes and closes the file. The destructor does the same, but ignores errors.
  void close();

 private:
  struct Implementation;
  explicit Writer(std::unique_ptr<Implementation> implementation);
  template <class Action>
  void use(Action action);

  std::unique_ptr<Implementation> implementation_;
};

/// Whether FrameFile and the functions below read files in child processes, which they do unless
/// this is called with false, or the environment variable NEEDLEWORK_FORK is 0. For programs that
/// must not fork, such as those of MPI.
///
/// The child process is a fork of the calling thread. It answers until the FrameFile is destroyed,
/// or the function returns, and has limits of memory and time, so that a file on which HDF5
/// crashes, hangs or takes all memory is an IoError or an InputError. Without it such a file ends
/// the program. In both cases HDF5 loads no plugins and follows no links into other files.
void set_reads_in_child_process(bool apart);

/// The frames of any H5MD file that has position, velocity, orientation and angular_velocity in
/// /particles/needles, or in the only group under /particles, whatever its name.
///
/// Each of the four may be an H5MD element [F][N][3] or a plain dataset [N][3], with numbers of any
/// type. Box edges may be [3], [3][3] (a diagonal matrix), [F][3] or [F][3][3], as a plain dataset
/// or an element. id and image may be plain datasets, elements or absent. Bodies are those of
/// /parameters, their mass otherwise that of the particles. If elements have different steps, the
/// frames are the steps that all of them have. Centres may lie on the edges of the box or outside.
/// Numbers are not changed: |u| = 1 must hold within 1e-6, and u·w = 0 within 1e-6 |w|.
///
/// Throws IoError if the file cannot be read or is cut short, and InputError for wrong content,
/// "PATH: /DATASET[index] = VALUE: expected ...".
class FrameFile {
 public:
  /// Opens the file. Frames that are written to it afterwards are not seen.
  explicit FrameFile(const std::string& path);
  FrameFile(const FrameFile&) = delete;
  FrameFile& operator=(const FrameFile&) = delete;
  ~FrameFile();

  /// Number of frames, at least 1.
  std::size_t count() const;
  /// Number of needles, of which none has been read yet.
  std::size_t needles() const;
  /// What it says of its bodies, which states have, too.
  Bodies bodies() const;
  /// Time of a frame [time], or nothing if the file does not have it.
  std::optional<double> time(std::size_t frame) const;
  /// Reads a frame. Frames are counted from 0; throws std::invalid_argument beyond the last.
  State read(std::size_t frame) const;

 private:
  struct Implementation;
  std::unique_ptr<Implementation> implementation_;
};

/// Reads the last frame of a FrameFile.
State read_last_frame(const std::string& path);

/// What a file holds of a run, without its frames and events.
struct RecordedRun {
  std::string scene;              ///< Scene::text
  std::string version;            ///< version of the program
  std::uint64_t needles = 0;      ///< number of needles
  std::vector<Totals> series;     ///< empty if `with_series` was false
  std::vector<WallTotals> walls;  ///< at the end, without area; the same
  std::vector<double> pressure;   ///< mean over the run on each of these walls
  EnergyBudget energy;            ///< at the end, where there are walls or driving
  /// Numbers of bodies that grow, at the end: growth_NAME of GrowthTotals and, where it was
  /// observed, network_NAME of their contact_network.
  std::vector<std::pair<std::string, double>> growth;
};

/// Reads a file that a Writer wrote. Throws IoError if it cannot be read, and InputError if
/// something is missing or has a form that a Writer does not write.
RecordedRun read_run(const std::string& path, bool with_series = true);

/// The text that `needlework info FILE` prints: an overview of a file of this library, of any H5MD
/// file or of any other HDF5 file, then its datasets with their shapes and descriptions. Throws
/// IoError if the file cannot be read.
std::string describe(const std::string& path);

}  // namespace needlework::io
