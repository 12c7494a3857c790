// Which bodies that grow hold each other, as they are about to jam. Two bodies count as in contact
// where the gap between their surfaces is below a share of their contact distance (D1 + D2) / 2,
//
//   gap        1000 / Z, at most 0.01; Z = P V / (N T) as it was last measured, 0.01 before
//
// as gaps of bodies that hold each other are about 1 / Z. A body and a wall are in contact where
// that between them is below this share of D / 2.
//
//   rattlers   bodies with fewer contacts than hold one in place, 4 of a sphere, 6 of a rod. They
//              are taken off with their contacts, again and again until no more are found.
//   contacts   mean number of contacts of the others, those with walls included; NaN if there are
//              none
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

#include "src/observe/described_fields.h"
#include "src/observe/registry.h"
#include "src/scene/rod_grid.h"

namespace needlework::observe {
namespace {

struct ContactNetwork {
  double contacts = std::numeric_limits<double>::quiet_NaN();
  std::uint64_t rattlers = 0;
  double gap = 0;

  template <class Visit>
  constexpr void for_each(Visit&& visit) const {
    visit(Described{"contacts", unit::none,
                    "Mean number of contacts of bodies that are no rattlers, with others and with "
                    "walls; NaN if there are none"},
          contacts);
    visit(Described{"rattlers", unit::none,
                    "Number of bodies that fewer than 4 contacts hold, of rods 6, without those "
                    "with rattlers"},
          rattlers);
    visit(Described{"gap", unit::none,
                    "Gap between bodies below which they are in contact, in contact distances"},
          gap);
  }
};

/// Takes off bodies with fewer than so many contacts, until there are no more. `contacts` are those
/// of each with others, `with_walls` their numbers of those with walls.
ContactNetwork network_of(const std::vector<std::vector<std::size_t>>& contacts,
                          const std::vector<std::size_t>& with_walls,
                          const std::vector<std::size_t>& least) {
  std::vector<std::size_t> held_by = with_walls, falling;
  std::vector<bool> is_rattler(contacts.size());
  const auto look_at = [&](std::size_t i) {
    if (is_rattler[i] || held_by[i] >= least[i]) return;
    is_rattler[i] = true;
    falling.push_back(i);
  };
  for (std::size_t i = 0; i < contacts.size(); ++i) held_by[i] += contacts[i].size();
  for (std::size_t i = 0; i < contacts.size(); ++i) look_at(i);
  ContactNetwork out;
  while (!falling.empty()) {
    const std::size_t i = falling.back();
    falling.pop_back();
    ++out.rattlers;
    for (const std::size_t other : contacts[i]) {
      --held_by[other];
      look_at(other);
    }
  }
  std::size_t all = 0;
  for (std::size_t i = 0; i < contacts.size(); ++i) all += is_rattler[i] ? 0 : held_by[i];
  const std::size_t others = contacts.size() - out.rattlers;
  if (others > 0) out.contacts = static_cast<double>(all) / static_cast<double>(others);
  return out;
}

class ContactNetworks : public Observable {
 public:
  explicit ContactNetworks(const GasSetting& gas) : gas_(gas) {}

  std::vector<SeriesField> fields() const override { return fields_of(ContactNetwork{}); }

  void sample(const Snapshot& now, Row& row) override {
    constexpr double widest = 0.01, in_mean_gaps = 1000;
    const double pressure = now.species.growth.pressure;
    const double gap = pressure > 0 ? std::min(widest, in_mean_gaps / pressure) : widest;
    const State& state = now.state;
    const std::size_t count = state.size();
    std::vector<RodShape> shapes;
    std::vector<std::size_t> least, with_walls;
    for (std::size_t i = 0; i < count; ++i) {
      const auto index = static_cast<SpeciesIndex>(now.species_of(i));
      const Species& species = gas_.composition[index];
      const OwnBodies& own = state.own_bodies;
      const double length = own.length.empty() ? species.length : own.length[i];
      const double diameter = own.diameter.empty() ? species.diameter : own.diameter[i];
      // Two that are wider by this overlap if they are in contact.
      shapes.push_back({length, diameter * (1 + gap), index});
      least.push_back(length > 0 ? 6 : 4);
      with_walls.push_back(contacts_with_walls(now, i, shapes.back()));
    }
    RodGrid grid(gas_.composition, shapes, gas_.box);
    std::vector<std::vector<std::size_t>> contacts(count);
    for (std::size_t i = 0; i < count; ++i) {
      const Vector &centre = state.position[i], &director = state.orientation[i];
      for (const RodGrid::Overlap& with : grid.overlaps(centre, director, shapes[i], 0)) {
        contacts[i].push_back(with.other);
        contacts[with.other].push_back(i);
      }
      grid.enter(centre, director, shapes[i]);
    }
    ContactNetwork network = network_of(contacts, with_walls, least);
    network.gap = gap;
    put_numbers(row, network);
  }

 private:
  static std::size_t contacts_with_walls(const Snapshot& now, std::size_t i, const RodShape& rod) {
    std::size_t out = 0;
    for (const WallTotals& wall : now.species.walls) {
      const auto axis = static_cast<std::size_t>(wall.axis);
      const double off = wall.place - now.state.position[i][axis];
      const double reach =
          0.5 * rod.length * std::abs(now.state.orientation[i][axis]) + 0.5 * rod.diameter;
      out += (wall.high ? off : -off) < reach;
    }
    return out;
  }

  GasSetting gas_;
};

}  // namespace

ObservablePointer make_contact_network(const GasSetting& gas) {
  return std::make_unique<ContactNetworks>(gas);
}

}  // namespace needlework::observe
