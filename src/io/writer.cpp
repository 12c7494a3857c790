// Writes H5MD files that stay readable when the program is killed.
//
// OutputFile keeps the metadata on disk consistent at any moment, which requires that all objects
// are created before the first row is written. The datasets of a frame grow one after the other, so
// the file can contain a part of a frame. Steps are written after everything else has reached the
// file; a reader that reads as many rows as there are steps reads complete frames only. A file that
// is continued is shortened to complete rows first, and then grows in the same way.
#include <optional>
#include <stdexcept>
#include <utility>

#include "needlework/error.h"
#include "needlework/h5md.h"
#include "src/io/atomic_file.h"
#include "src/io/continuation.h"
#include "src/io/hdf5.h"
#include "src/io/in_child_process.h"
#include "src/io/layout.h"
#include "src/io/output_file.h"
#include "src/io/source.h"
#include "src/io/tables.h"

namespace needlework::io {

using hdf5::Session;

namespace {

// Number of samples or events that are collected in memory before they are written. Events fill
// one chunk of the file.
constexpr std::size_t block = 8192;
// The same for numbers of observables, of which a sample can have millions.
constexpr std::size_t numbers_block = 131072;

}  // namespace

struct Writer::Implementation {
  explicit Implementation(const std::string& name)
      : path(name), absolute_path(absolute_name(name)) {}

  void create(bool force, const Scene& scene, const RunInfo& run);
  void resume(const Scene& scene, const RunInfo& run, const Position& from,
              const std::function<void()>& approve);
  void open_datasets(const Scene& scene, const RunInfo& run);
  void commit();
  void sync();
  void close();

  const std::string path;
  const std::string absolute_path;  // the process may go to another folder
  bool has_kinds = false;
  bool failed = false;
  bool name_on_disk = false;
  Position position;
  std::optional<OutputFile> file;  // declared first, so that it is closed after its datasets
  std::optional<Frames> frames;
  std::optional<TotalsTable> observables;
  std::optional<StepsAndTimes> frame_times;
  std::optional<TotalsTable> series;
  std::optional<FieldsTable> fields;
  std::optional<StepsAndTimes> series_times;
  std::optional<VelocitiesSetTable> velocities_set;
  std::optional<UserDataTable> data;
  std::optional<Events> events;

  // Rows whose steps are not in the file yet.
  std::vector<Totals> pending_frames;
  std::vector<Totals> pending_samples;
  std::vector<double> pending_numbers;
  std::vector<VelocitiesSet> pending_velocities_set;
  std::vector<DataEntry> pending_data;
  std::vector<Happening> pending_events;
};

void Writer::Implementation::create(bool force, const Scene& scene, const RunInfo& run) {
  AtomicFile atomic(path, force);
  file.emplace(atomic.temporary(), path, OutputFile::Use::growing);
  make_layout(file->get(), scene, run, path);
  open_datasets(scene, run);
  atomic.publish();
}

void Writer::Implementation::resume(const Scene& scene, const RunInfo& run, const Position& from,
                                    const std::function<void()>& approve) {
  file.emplace(path, path);
  if (approve) approve();
  // Before this process opens the file, which another one may have damaged.
  read_in_child_process(path, [&] {
    require_continuable(Source(path), scene, run, from);
    return true;
  });
  shorten(*file, path, from);
  position = from;
  open_datasets(scene, run);
}

void Writer::Implementation::open_datasets(const Scene& scene, const RunInfo& run) {
  has_kinds = run.has_kinds;
  file->start_swmr();
  frames.emplace(file->get(), path, position.frames);
  observables.emplace(file->get(), "/observables", path);
  frame_times.emplace(file->get(), "/particles/needles/position", path);
  series.emplace(file->get(), "/series", path);
  fields.emplace(file->get(), run.series, path);
  series_times.emplace(file->get(), "/series", path);
  velocities_set.emplace(file->get(), path);
  data.emplace(file->get(), path, position.data_bytes);
  if (scene.output.events) events.emplace(file->get(), run.has_kinds, path);
}

void Writer::Implementation::commit() {
  if (pending_frames.empty() && pending_samples.empty() && pending_velocities_set.empty() &&
      pending_data.empty() && pending_events.empty()) {
    return;
  }
  const Session session;
  observables->append(pending_frames);
  series->append(pending_samples);
  fields->append(pending_numbers);
  frame_times->append_times(pending_frames);
  series_times->append_times(pending_samples);
  velocities_set->append(pending_velocities_set);
  data->append(pending_data);
  if (events) events->append(pending_events);
  file->flush();
  frame_times->append_steps(pending_frames);
  series_times->append_steps(pending_samples);
  velocities_set->append_steps(pending_velocities_set);
  data->append_steps(pending_data);
  if (events) events->append_times(pending_events);
  file->flush();
  pending_frames.clear();
  pending_samples.clear();
  pending_numbers.clear();
  pending_velocities_set.clear();
  pending_data.clear();
  pending_events.clear();
}

void Writer::Implementation::sync() {
  const Session session;
  commit();
  file->sync();
  file->require_named(absolute_path);
  if (!std::exchange(name_on_disk, true)) sync_name(absolute_path);
}

void Writer::Implementation::close() {
  const Session session;
  commit();
  events.reset();
  data.reset();
  velocities_set.reset();
  series_times.reset();
  fields.reset();
  series.reset();
  frame_times.reset();
  observables.reset();
  frames.reset();
  file->close();
  file->require_named(absolute_path);
}

template <class Action>
void Writer::use(Action action) {
  if (!implementation_) throw std::logic_error("the writer was closed before");
  if (implementation_->failed) {
    throw IoError(implementation_->path + ": an earlier write to this file failed");
  }
  try {
    action(*implementation_);
    implementation_->file->require_written();
  } catch (const IoError&) {
    implementation_->failed = true;
    throw;
  }
}

Writer::Writer(const std::string& path, bool force, const Scene& scene, const RunInfo& run) {
  const Session session;
  implementation_ = std::make_unique<Implementation>(path);
  implementation_->create(force, scene, run);
}

Writer::Writer(std::unique_ptr<Implementation> implementation)
    : implementation_(std::move(implementation)) {}

Writer Writer::resume(const std::string& path, const Scene& scene, const RunInfo& run,
                      const Position& position, const std::function<void()>& approve) {
  const Session session;
  auto implementation = std::make_unique<Implementation>(path);
  implementation->resume(scene, run, position, approve);
  return Writer(std::move(implementation));
}

Writer::Writer(Writer&&) noexcept = default;

Writer& Writer::operator=(Writer&& other) noexcept {
  if (this != &other) {
    Writer old(std::move(*this));
    implementation_ = std::move(other.implementation_);
  }
  return *this;
}

Writer::~Writer() {
  if (!implementation_ || implementation_->failed) return;
  try {
    close();
  } catch (const std::exception&) {
    // A destructor cannot report errors; close() can.
  }
}

void Writer::write_series(const Totals& totals, std::span<const double> values) {
  use([&](Implementation& out) {
    if (values.size() != out.fields->width()) {
      throw std::logic_error("a sample does not have the numbers of the fields of RunInfo::series");
    }
    out.pending_samples.push_back(totals);
    ++out.position.samples;
    out.pending_numbers.insert(out.pending_numbers.end(), values.begin(), values.end());
    const bool full = out.pending_samples.size() >= block;
    if (full || out.pending_numbers.size() >= numbers_block) out.commit();
  });
}

void Writer::write_frame(const Totals& totals, const State& state) {
  use([&](Implementation& out) {
    const Session session;
    out.frames->append(state);
    out.pending_frames.push_back(totals);
    ++out.position.frames;
  });
}

void Writer::write_event(const Happening& happening) {
  use([&](Implementation& out) {
    if (!out.events) throw std::logic_error("the scene does not ask for output.events");
    if (!out.has_kinds && !happening.is_collision()) {
      throw std::logic_error("an event that is no collision, in a file without kinds of events");
    }
    out.pending_events.push_back(happening);
    ++out.position.events;
    if (out.pending_events.size() >= block) out.commit();
  });
}

void Writer::write_velocities_set(const Totals& before, const Totals& after) {
  use([&](Implementation& out) {
    out.pending_velocities_set.push_back({before, after});
    ++out.position.velocities_set;
    if (out.pending_velocities_set.size() >= block) out.commit();
  });
}

void Writer::write_data(const Totals& now, const std::string& name, const UserData* data) {
  require_valid_data(name, data ? *data : UserData{});
  use([&](Implementation& out) {
    out.pending_data.push_back({now, name, data ? std::optional(*data) : std::nullopt});
    ++out.position.data;
    if (data) out.position.data_bytes += data->bytes.size();
    // Values may be large.
    if (out.pending_data.size() >= block || (data && data->bytes.size() > block)) out.commit();
  });
}

void Writer::flush() {
  use([](Implementation& out) { out.commit(); });
}

void Writer::sync() {
  use([](Implementation& out) { out.sync(); });
}

void Writer::require_writable() {
  use([](Implementation&) {});
}

Writer::Position Writer::position() const {
  if (!implementation_) throw std::logic_error("the writer was closed before");
  return implementation_->position;
}

void Writer::close() {
  use([](Implementation& out) { out.close(); });
  implementation_.reset();
}

}  // namespace needlework::io
