// Displacement and rotation since reference times t0, as means over all needles of
//
//   parallel       ((r(t) - r(t0)) . u(t0))^2
//   perpendicular  |r(t) - r(t0)|^2 less the above: both directions across
//   p1             u(t) . u(t0)
//   p2             (3 (u(t) . u(t0))^2 - 1) / 2
//
// with r followed across the boundaries. Each row has the lag t - t0 and these means for every
// reference; places without a reference have NaN. A correlation function is the mean over rows and
// references of equal lag.
//
// References are samples. At most 8 are kept, spread evenly over all samples so far: every
// `stride_`-th sample becomes one, and when there is no place left every second one is dropped and
// the stride doubled. So memory is bounded, the first sample is always a reference, and a run of
// any length has lags from one sample to all of it. Samples at equal steps make lags that repeat
// and can be averaged; at logarithmic times, references are spread over the decades.
#include <bit>
#include <cmath>
#include <limits>

#include "src/observe/moved.h"
#include "src/observe/registry.h"

namespace needlework::observe {
namespace {

constexpr std::size_t places = 8;

struct Reference {
  std::size_t sample;  ///< its number, counted from 0
  double time;
  std::vector<Vector> position, orientation;
};

void transfer(Archive& archive, Reference& reference) {
  archive(reference.sample, reference.time, reference.position, reference.orientation);
}

class Displacement : public Observable {
 public:
  explicit Displacement(const GasSetting& gas) : gas_(gas) {}

  std::vector<SeriesField> fields() const override {
    const std::vector<SeriesField::Extent> shape{{"references", places}};
    return {
        {"lag", "Time since each reference", unit::time, shape},
        {"parallel", "Mean square displacement along the orientation at each reference", unit::area,
         shape},
        {"perpendicular", "Mean square displacement across the orientation at each reference",
         unit::area, shape},
        {"p1", "Mean cosine of the angle between the orientation and that at each reference",
         unit::none, shape},
        {"p2", "Mean of (3 cos^2 - 1) / 2 of the same angle", unit::none, shape},
    };
  }

  void sample(const Snapshot& now, Row& row) override {
    const std::vector<Vector> position = unwrapped(now.state);
    keep(now, position);
    std::vector<Moved> means;
    for (const Reference& reference : references_) {
      means.push_back(
          moved(reference.position, reference.orientation, position, now.state.orientation));
    }
    put(row, [&](std::size_t n) { return now.totals.time - references_[n].time; });
    for (double Moved::*mean : {&Moved::parallel, &Moved::perpendicular, &Moved::p1, &Moved::p2}) {
      put(row, [&](std::size_t n) { return means[n].*mean; });
    }
  }

  void transfer(Archive& archive) override {
    archive(samples_, stride_, references_);
    archive.require(std::has_single_bit(stride_) && references_.size() <= places &&
                    references_.size() == samples_ / stride_ + (samples_ % stride_ != 0));
    for (std::size_t n = 0; n < references_.size(); ++n) {
      const Reference& reference = references_[n];
      archive.require(reference.sample == n * stride_ && std::isfinite(reference.time) &&
                      reference.position.size() == gas_.count &&
                      reference.orientation.size() == gas_.count);
    }
  }

 private:
  void keep(const Snapshot& now, const std::vector<Vector>& position) {
    const std::size_t sample = samples_++;
    if (sample % stride_ != 0) return;
    if (references_.size() == places) {
      stride_ *= 2;
      std::erase_if(references_, [&](const Reference& old) { return old.sample % stride_ != 0; });
    }
    // With an even number of places, the sample is a multiple of the doubled stride as well.
    references_.push_back({sample, now.totals.time, position, now.state.orientation});
  }
  static_assert(places % 2 == 0);

  template <class Value>
  void put(Row& row, Value value) const {
    for (std::size_t n = 0; n < places; ++n) {
      row.put(n < references_.size() ? value(n) : std::numeric_limits<double>::quiet_NaN());
    }
  }

  GasSetting gas_;
  std::size_t samples_ = 0, stride_ = 1;
  std::vector<Reference> references_;
};

}  // namespace

ObservablePointer make_displacement(const GasSetting& gas) {
  return std::make_unique<Displacement>(gas);
}

}  // namespace needlework::observe
