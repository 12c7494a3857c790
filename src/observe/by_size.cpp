// The needles of each species in the order of their sizes, and of ids where these are equal, cut
// into Q classes: number n of N, from 0 on, is in class floor(n Q / N). The size is the length of
// the axis, of spheres the diameter. Of the needles of a class
//
//   t_tr        <m v^2> / 3
//   t_rot       <I w^2> / 2, <I w^2> / 3 of rough spheres
//   collisions  that they have taken part in since the start of the run, each counted once for
//               either needle
//
// and, if the displacement is observed, what that has of them. In elastic equilibrium t_rot is T,
// and t_tr is T (1 - <m> / M) with M the mass of all needles, or T beside walls and fixed needles.
//
// Their pressure is left out: which part of the virial of a collision belongs to either needle is a
// matter of choice. Rates of collisions are not, and those of thin needles are known exactly.
#include "src/observe/by_size.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>
#include <stdexcept>
#include <utility>

#include "src/observe/by_species.h"
#include "src/observe/registry.h"

namespace needlework::observe {
namespace {

// Which class each needle is in, and what they are.
struct Classes {
  std::vector<std::uint32_t> of_row;  ///< by species, then class
  std::vector<double> count, mean_size;
  std::vector<GasSetting> gas;
};

double size_of(const SpeciesById& needles, std::size_t row, const Species& species) {
  const OwnBodies& own = needles.own();
  if (species.has_axis()) return own.empty() ? species.length : own.length[row];
  return own.empty() ? species.diameter : own.diameter[row];
}

Classes classes_of(const GasSetting& gas, std::size_t classes) {
  const SpeciesById& needles = gas.species_by_id;
  if (needles.size() != gas.count)
    throw std::logic_error("classes of size: expected the ids of all needles");
  const std::size_t kinds = gas.composition.size();
  Classes out{.of_row = std::vector<std::uint32_t>(needles.size()),
              .count = std::vector<double>(kinds * classes),
              .mean_size = std::vector<double>(kinds * classes),
              .gas = {}};
  std::vector<std::vector<std::size_t>> rows(kinds);
  for (std::size_t row = 0; row < needles.size(); ++row)
    rows[needles.species_of_row(row)].push_back(row);
  for (std::size_t n = 0; n < kinds; ++n) {
    const Species& species = gas.composition[n];
    const auto size = [&](std::size_t row) { return size_of(needles, row, species); };
    std::ranges::stable_sort(rows[n], {}, size);
    for (std::size_t rank = 0; rank < rows[n].size(); ++rank) {
      const std::size_t part = n * classes + rank * classes / rows[n].size();
      out.of_row[rows[n][rank]] = static_cast<std::uint32_t>(part);
      ++out.count[part];
      out.mean_size[part] += size(rows[n][rank]);
    }
    for (std::size_t part = n * classes; part < (n + 1) * classes; ++part) {
      out.mean_size[part] /= out.count[part];
      GasSetting& of = out.gas.emplace_back(gas.of_species(n));
      of.count = static_cast<std::size_t>(out.count[part]);
      of.composition.set_count(0, of.count);
    }
  }
  return out;
}

class BySize : public Observable {
 public:
  BySize(const GasSetting& gas, Classes classes, std::vector<SeriesField::Extent> extents,
         bool follows)
      : gas_(gas),
        of_row_(std::move(classes.of_row)),
        count_(std::move(classes.count)),
        mean_size_(std::move(classes.mean_size)),
        extents_(std::move(extents)),
        parts_(std::move(classes.gas)),
        collisions_(count_.size()) {
    if (follows) displacement_.emplace(extents_, make_displacement, parts_);
  }

  std::vector<SeriesField> fields() const override {
    using enum SeriesField::Kind;
    std::vector<SeriesField> out{
        {"t_tr", "Translational temperature of each class", unit::energy, extents_},
        {"t_rot", "Rotational temperature of each class", unit::energy, extents_},
        {"collisions",
         "Number of collisions since the start of the run that the needles of each class have "
         "taken "
         "part in",
         unit::none, extents_, SeriesField::Kind::count},
        {"count", "Number of needles of each class", unit::none, extents_, constant, count_},
        {"mean_size", "Mean size of the needles of each class", unit::length, extents_, constant,
         mean_size_},
    };
    if (!displacement_) return out;
    for (SeriesField& field : displacement_->fields()) out.push_back(std::move(field));
    return out;
  }

  void sample(const Snapshot& now, Row& row) override {
    const std::vector<SpeciesTotals> totals = totals_of(now);
    for (const SpeciesTotals& each : totals) row.put(each.t_tr);
    for (const SpeciesTotals& each : totals) row.put(each.t_rot);
    for (const std::uint64_t each : collisions_) row.put(static_cast<double>(each));
    if (!displacement_) return;
    parts_.take(now, std::span<const std::uint32_t>(of_row_), totals);
    displacement_->sample(now, row);
  }

  bool reads_collisions() const override { return true; }
  void collision(const Collision& c) override {
    for (const std::uint32_t id : {c.first, c.second}) {
      const std::size_t row = gas_.species_by_id.row(id);
      if (row < of_row_.size()) ++collisions_[of_row_[row]];
    }
  }

  void transfer(Archive& archive) override {
    archive(collisions_);
    archive.require(collisions_.size() == count_.size());
    if (displacement_) displacement_->transfer(archive);
  }

 private:
  std::vector<SpeciesTotals> totals_of(const Snapshot& now) const {
    std::vector<SpeciesTotals> out(count_.size());
    const Weights& weights = now.weights();
    for (std::size_t i = 0; i < now.state.size(); ++i) {
      const Species& species = gas_.composition[now.species_of(i)];
      const Vector &v = now.state.velocity[i], &w = now.state.angular_velocity[i];
      SpeciesTotals& of = out[of_row_[i]];
      of.t_tr += species.mass * weights.mass(i) * dot(v, v);
      of.t_rot +=
          species.inertia() * weights.inertia(i) * dot(w, w) * (species.has_axis() ? 1 : 2. / 3);
    }
    for (std::size_t part = 0; part < out.size(); ++part) {
      out[part].count = static_cast<std::uint64_t>(count_[part]);
      out[part].t_tr /= 3 * count_[part];
      out[part].t_rot /= 2 * count_[part];
    }
    return out;
  }

  GasSetting gas_;
  std::vector<std::uint32_t> of_row_;
  std::vector<double> count_, mean_size_;
  std::vector<SeriesField::Extent> extents_;
  SnapshotsOfParts parts_;
  std::optional<ByPart> displacement_;
  std::vector<std::uint64_t> collisions_;
};

}  // namespace

ObservablePointer make_by_size(const GasSetting& gas, int classes, bool follows) {
  const auto number = static_cast<std::size_t>(classes);
  std::vector<SeriesField::Extent> extents{{"size classes", number}};
  if (gas.composition.is_mixture())
    extents.insert(extents.begin(), {"species", gas.composition.size()});
  return std::make_unique<BySize>(gas, classes_of(gas, number), std::move(extents), follows);
}

}  // namespace needlework::observe
