// Writes H5MD files so that a crash leaves them readable.
//
// OutputFile sees to it that the metadata on disk are consistent at any moment; for that, all
// objects are made before the first row. The datasets of one frame may still grow one after the
// other. So steps and times are written when all the rest has reached the file, and a reader that
// goes by them never sees half a frame.
#include <optional>
#include <stdexcept>
#include <utility>

#include "needlework/error.h"
#include "needlework/h5md.h"
#include "src/io/atomic_file.h"
#include "src/io/hdf5.h"
#include "src/io/layout.h"
#include "src/io/output_file.h"
#include "src/io/tables.h"

namespace needlework::io {

using hdf5::Session;

namespace {

// Rows kept in memory before they are written; of events, those of a chunk.
constexpr std::size_t block = 8192;

}  // namespace

struct Writer::Implementation {
  Implementation(const std::string& name, bool force, const Scene& scene, const RunInfo& run);

  void open_datasets(bool with_events);
  void commit();
  void close();

  const std::string path;
  bool failed = false;
  std::optional<OutputFile> file;  // outlives the datasets in it
  std::optional<Frames> frames;
  std::optional<TotalsTable> observables;
  std::optional<Clock> frames_clock;
  std::optional<TotalsTable> series;
  std::optional<Clock> series_clock;
  std::optional<Events> events;

  // Not committed yet: their steps and times are not in the file.
  std::vector<Totals> pending_frames;
  std::vector<Totals> pending_samples;
  std::vector<Collision> pending_events;
};

Writer::Implementation::Implementation(const std::string& name, bool force, const Scene& scene,
                                       const RunInfo& run)
    : path(name) {
  AtomicFile atomic(path, force);
  file.emplace(atomic.temporary(), path, OutputFile::Use::growing);
  make_layout(file->get(), scene, run, path);
  file->start_swmr();
  open_datasets(scene.output.events);
  atomic.publish();
}

void Writer::Implementation::open_datasets(bool with_events) {
  frames.emplace(file->get(), path);
  observables.emplace(file->get(), "/observables", path);
  frames_clock.emplace(file->get(), "/particles/needles/position", path);
  series.emplace(file->get(), "/series", path);
  series_clock.emplace(file->get(), "/series", path);
  if (with_events) events.emplace(file->get(), path);
}

void Writer::Implementation::commit() {
  if (pending_frames.empty() && pending_samples.empty() && pending_events.empty()) return;
  const Session session;
  observables->append(pending_frames);
  series->append(pending_samples);
  if (events) events->append(pending_events);
  file->flush();
  frames_clock->append(pending_frames);
  series_clock->append(pending_samples);
  if (events) events->append_times(pending_events);
  file->flush();
  pending_frames.clear();
  pending_samples.clear();
  pending_events.clear();
}

void Writer::Implementation::close() {
  const Session session;
  commit();
  events.reset();
  series_clock.reset();
  series.reset();
  frames_clock.reset();
  observables.reset();
  frames.reset();
  file->close();
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
  implementation_ = std::make_unique<Implementation>(path, force, scene, run);
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
    // close() is there for those who want to know.
  }
}

void Writer::write_series(const Totals& totals) {
  use([&](Implementation& out) {
    out.pending_samples.push_back(totals);
    if (out.pending_samples.size() >= block) out.commit();
  });
}

void Writer::write_frame(const Totals& totals, const State& state) {
  use([&](Implementation& out) {
    const Session session;
    out.frames->append(state);
    out.pending_frames.push_back(totals);
  });
}

void Writer::write_event(const Collision& collision) {
  use([&](Implementation& out) {
    if (!out.events) throw std::logic_error("the scene does not ask for output.events");
    out.pending_events.push_back(collision);
    if (out.pending_events.size() >= block) out.commit();
  });
}

void Writer::flush() {
  use([](Implementation& out) { out.commit(); });
}

void Writer::close() {
  use([](Implementation& out) { out.close(); });
  implementation_.reset();
}

}  // namespace needlework::io
