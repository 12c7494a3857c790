#include "src/io/descriptions.h"

#include <fmt/format.h>

#include <string_view>

#include "src/io/hdf5.h"
#include "src/io/sums.h"

namespace needlework::io {

using hdf5::Handle;

namespace {

const std::string length = "length";
const std::string time = "time";
const std::string energy = "energy";
const std::string speed = "length per time";
const std::string angular_speed = "radians per time";
const std::string momentum = "mass times length per time";
const std::string none;

std::string dimensions(const hdf5::Shape& shape) {
  std::string out;
  for (const hsize_t extent : shape) out += fmt::format("[{}]", extent);
  return out;
}

// The sums over all needles that files hold more than once: at the times of frames, at the times of
// the series, and as means over runs. `shape` is that of the scalar sums.
std::vector<Description> totals(const std::string& group, const std::string& shape) {
  std::vector<Description> out;
  Totals::for_each_sum([&](const Described& sum, auto member) {
    const std::string row = dimensions(InFile<ValueOf<decltype(member)>>::shape());
    out.push_back(
        {group + "/" + sum.name, sum.meaning, sum.unit, shape.empty() ? none : shape + row});
  });
  return out;
}

std::vector<Description> changes_of_velocities() {
  std::vector<Description> out;
  for_each_of_velocities([&](const Described& sum, auto member) {
    out.push_back({fmt::format("/velocities_set/{}", sum.name),
                   fmt::format("{} before and after", sum.name), sum.unit,
                   "[changes][2]" + dimensions(InFile<ValueOf<decltype(member)>>::shape())});
  });
  return out;
}

void append(std::vector<Description>& list, const std::vector<Description>& more) {
  list.insert(list.end(), more.begin(), more.end());
}

// Over the runs of a sweep. `row` is the shape of a row.
std::vector<Description> means(const std::string& path, const std::string& row) {
  return {{path + "/mean", "Mean over the runs of the point", none, "[samples]" + row},
          {path + "/standard_error", "Standard error of the mean", none, "[samples]" + row}};
}

// The paths of the objects in the file that `pattern` fits.
std::vector<std::string> matches(hid_t file, const std::string& pattern, const std::string& place) {
  const auto star = pattern.find('*');
  if (star == std::string::npos) {
    if (pattern != "/" && !hdf5::exists(file, pattern, place)) return {};
    return {pattern};
  }
  const auto begin = pattern.rfind('/', star) + 1;
  const std::string parent = pattern.substr(0, begin), start = pattern.substr(begin, star - begin);
  if (!hdf5::is_group(file, parent, place)) return {};
  std::vector<std::string> paths;
  for (const std::string& name :
       hdf5::children(hdf5::open_group(file, parent, place).get(), place)) {
    if (!name.starts_with(start)) continue;
    const auto more = matches(file, parent + name + pattern.substr(star + 1), place);
    paths.insert(paths.end(), more.begin(), more.end());
  }
  return paths;
}

void write_description(hid_t file, const std::string& path, const std::string& text,
                       const std::string& place) {
  const Handle object(H5Oopen(file, path.c_str(), H5P_DEFAULT), H5Oclose, place);
  if (hdf5::check(H5Aexists(object.get(), "description"), place) > 0) return;
  hdf5::write_text_attribute(object.get(), "description", text, place);
}

}  // namespace

std::string sentence(const Description& description) {
  std::string text = description.meaning;
  const std::string_view unit = description.unit, per = "per ";
  if (unit.starts_with(per))
    text += fmt::format(", in units of 1/{}", unit.substr(per.size()));
  else if (!unit.empty())
    text += fmt::format(", in units of {}", unit);
  if (description.shape.starts_with('[')) text += ", with shape " + description.shape;
  return text + ".";
}

std::vector<Description> run_file_descriptions() {
  const std::string scalar = "scalar";
  std::vector<Description> list{
      {"/", "Run of a gas of hard needles, in the H5MD format", none, none},
      {"/h5md", "Version of the H5MD format, author and creator of the file", none, none},
      {"/h5md/author", "Author of the file", none, none},
      {"/h5md/creator", "Program that wrote the file, and its version", none, none},

      {"/parameters", "Scene and settings of the run", none, none},
      {"/parameters/scene", "Scene file as read, followed by the keys that were set over it", none,
       scalar},
      {"/parameters/title", "Title of the scene", none, scalar},
      {"/parameters/version", "Version of the program that made the run", none, scalar},
      {"/parameters/seed", "Seed of the random numbers from which the initial state was drawn",
       none, scalar},
      {"/parameters/isa", "Instruction set that the run used", none, scalar},
      {"/parameters/accuracy",
       "Accuracy level of the search for contacts, and the settings that differ from it", none,
       scalar},
      {"/parameters/threads", "Number of threads that the run used", none, scalar},
      {"/parameters/epoch_length", "Length of an epoch, in which the times of events are counted",
       time, scalar},
      {"/parameters/k", "Shape of the needles, k = m L^2 / (2 I)", none, scalar},
      {"/parameters/length", "Length of a needle", length, scalar},
      {"/parameters/mass", "Mass of a needle", "mass", scalar},
      {"/parameters/epsilon", "Coefficient of normal restitution", none, scalar},
      {"/parameters/beta", "Coefficient of tangential restitution", none, scalar},

      {"/particles", "Groups of particles, of which the needles are the only one", none, none},
      {"/particles/needles", "State of all needles at the times of the frames", none, none},
      {"/particles/needles/box", "Rectangular periodic box", none, none},
      {"/particles/needles/box/edges", "Edge vectors of the box as the rows of a diagonal matrix",
       length, "[frames][3][3]"},
      {"/particles/needles/position", "Centre of each needle, inside the box", length,
       "[frames][needles][3]"},
      {"/particles/needles/position/step", "Number of collisions before each frame", none,
       "[frames]"},
      {"/particles/needles/position/time", "Time of each frame since the start of the run", time,
       "[frames]"},
      {"/particles/needles/image",
       "Number of box edges to add to each centre to follow its path across the boundaries", none,
       "[frames][needles][3]"},
      {"/particles/needles/velocity", "Velocity of the centre of each needle", speed,
       "[frames][needles][3]"},
      {"/particles/needles/orientation", "Unit vector along each needle", none,
       "[frames][needles][3]"},
      {"/particles/needles/angular_velocity",
       "Angular velocity of each needle, perpendicular to its orientation but for spheres",
       angular_speed, "[frames][needles][3]"},
      {"/particles/needles/id", "Identity of each needle, the same in all frames", none,
       "[needles]"},
      {"/particles/needles/mass", "Mass of each needle", "mass", "[needles]"},
      {"/particles/needles/species",
       "Species of each needle, counted from 0 in the order of the scene", none, "[needles]"},

      {"/observables", "Sums over all needles at the times of the frames", none, none},
      {"/series", "Sums over all needles, theory and observables at the times of the samples", none,
       none},
      {"/series/step", "Number of collisions before each sample", none, "[samples]"},
      {"/series/time", "Time of each sample since the start of the run", time, "[samples]"},

      {"/velocities_set",
       "Where a caller has replaced all velocities; from then on kinetic theory is not a number",
       none, none},
      {"/velocities_set/step", "Number of collisions before each change", none, "[changes]"},
      {"/velocities_set/time", "Time of each change since the start of the run", time, "[changes]"},

      {"/user_data",
       "Data of the user's own in the order in which they were set; the last entry of a name holds",
       none, none},
      {"/user_data/step", "Number of collisions before each entry", none, "[entries]"},
      {"/user_data/time", "Time of each entry since the start of the run", time, "[entries]"},
      {"/user_data/name", "Name of each entry", none, "[entries]"},
      {"/user_data/json", "1 where the value is JSON in UTF-8, 0 where it is any bytes", none,
       "[entries]"},
      {"/user_data/begin", "Place in bytes where the value of each entry begins", none,
       "[entries]"},
      {"/user_data/size", "Number of bytes of the value; -1 where the name was removed", none,
       "[entries]"},
      {"/user_data/bytes", "The values, one after the other", none, "[bytes]"},

      {"/events", "All collisions in the order of their times", none, none},
      {"/events/time", "Time of each collision since the start of the run, rounded", time,
       "[events]"},
      {"/events/epoch", "Number of whole epochs before each collision", none, "[events]"},
      {"/events/offset", "Time of each collision since the beginning of its epoch, not rounded",
       time, "[events]"},
      {"/events/pair", "Identities of the two needles, the lower one first", none, "[events][2]"},
      {"/events/arms",
       "Signed distance of the contact from the centre of each of the two needles, along its "
       "orientation",
       length, "[events][2]"},
      {"/events/normal_velocity",
       "Velocity of the first needle relative to the second at the contact before the collision, "
       "along the vector product of their orientations",
       speed, "[events]"},
      {"/events/tc", "1 where the contact-time rule made the collision elastic, else 0", none,
       "[events]"},
      {"/events/shift",
       "Number of box edges added to the stored centre of the second needle to obtain the periodic "
       "image that was hit",
       none, "[events][3]"},
      {"/events/impulse", "Impulse on the first needle", momentum, "[events][3]"},
  };
  append(list, changes_of_velocities());
  append(list, totals("/observables", "[frames]"));
  append(list, totals("/series", "[samples]"));
  return list;
}

std::vector<Description> event_kind_descriptions() {
  const std::string each = "[events]";
  return {
      {"/events", "All collisions and events of single needles in the order of their times", none,
       none},
      {"/events/kind",
       "What each event is: 0 a collision of two needles, 1 a hit on a wall, 2 a contact entered, "
       "3 a contact ended, 4 velocities drawn by a thermostat, 255 something else",
       none, each},
      {"/events/time", "Time of each event since the start of the run, rounded", time, each},
      {"/events/epoch", "Number of whole epochs before each event", none, each},
      {"/events/offset", "Time of each event since the beginning of its epoch, not rounded", time,
       each},
      {"/events/pair",
       "Identities of the two needles, the lower one first; of one needle its identity and the "
       "index of the wall that it hits, or else 0",
       none, each + "[2]"},
      {"/events/arms",
       "Signed distance of the contact from the centre of each of the two needles, along its "
       "orientation; of one needle that of its tip, and 0",
       length, each + "[2]"},
      {"/events/normal_velocity",
       "Velocity of the first needle relative to the second at the contact before the event, along "
       "the vector product of their orientations; of a hit on a wall that of the tip relative to "
       "the surface, along the normal into the gas",
       speed, each},
      {"/events/tc", "1 where the contact-time rule made the event elastic, else 0", none, each},
      {"/events/shift",
       "Number of box edges added to the stored centre of the second needle to obtain the periodic "
       "image that was hit; of one needle 0",
       none, each + "[3]"},
      {"/events/impulse", "Impulse on the first needle", momentum, each + "[3]"},
  };
}

std::vector<Description> wall_descriptions() {
  return {{"/particles/needles/box",
           "Rectangular box, which is periodic along the axes without walls", none, none}};
}

std::vector<Description> moving_wall_descriptions() {
  return {{"/particles/needles/box",
           "Box of which walls move edges, periodic along the axes without walls", none, none},
          {"/particles/needles/box/edges",
           "Edge vectors of the box as the rows of a diagonal matrix, from one wall to the other",
           length, "[frames][3][3]"},
          {"/particles/needles/box/low",
           "Place of the low edges, of which a wall may have moved one; positions count from 0",
           length, "[frames][3]"}};
}

std::vector<Description> growth_descriptions() {
  return {{"/particles/needles/box/scale",
           "Sizes of all bodies in those of the start, which are in the parameters and in length "
           "and diameter of the needles",
           none, "[frames]"}};
}

std::vector<Description> shear_descriptions() {
  return {{"/particles/needles/box",
           "Box whose rows of images slide along x; shear_rate is that of the flow, rate * y", none,
           none},
          {"/particles/needles/box/edges",
           "Edge vectors of the box as the rows of a matrix; the second has the slide of the row "
           "of boxes above along x",
           length, "[frames][3][3]"},
          {"/particles/needles/peculiar_velocity",
           "Velocity of each needle beside the uniform flow", speed, "[frames][needles][3]"}};
}

std::vector<Description> rod_descriptions(bool of_each_species) {
  const std::string shape = of_each_species ? "[species]" : "scalar";
  return {
      {"/parameters/length", "Length of the axis of a rod, without its caps", length, shape},
      {"/parameters/diameter", "Diameter of a rod", length, shape},
      {"/parameters/inertia",
       "Moment of inertia about an axis through the centre, of a rod normal to it", "mass length^2",
       shape},
  };
}

std::vector<Description> mixture_descriptions() {
  const std::string each = "[species]", pairs = "[species][species]";
  return {
      {"/parameters/species", "Name of each species", none, each},
      {"/parameters/counts", "Number of needles of each species", none, each},
      {"/parameters/length", "Length of a needle of each species", length, each},
      {"/parameters/mass", "Mass of a needle of each species", "mass", each},
      {"/parameters/k", "Shape of the needles of each species, k = m L^2 / (2 I)", none, each},
      {"/parameters/epsilon", "Coefficient of normal restitution of each two species", none, pairs},
      {"/parameters/beta", "Coefficient of tangential restitution of each two species", none,
       pairs},
  };
}

std::vector<Description> passing_descriptions() {
  return {
      {"/parameters/meet", "Whether each two species meet, 1 or 0", none, "[species][species]"}};
}

std::vector<Description> own_body_descriptions() {
  const std::string each = "[needles]";
  return {{"/particles/needles/length", "Length of the axis of each needle", length, each},
          {"/particles/needles/diameter", "Diameter of each rod", length, each},
          {"/particles/needles/inertia",
           "Moment of inertia of each needle, about axes normal to it", "mass length^2", each}};
}

std::vector<Description> series_descriptions(const std::vector<SeriesGroup>& groups) {
  std::vector<Description> list;
  for (const SeriesGroup& group : groups) {
    const std::string path = "/series/" + group.name;
    list.push_back({path, group.meaning, none, none});
    for (const SeriesField& field : group.fields) {
      std::string shape = field.kind == SeriesField::Kind::constant ? "" : "[samples]";
      for (const auto& extent : field.shape) shape += "[" + extent.name + "]";
      list.push_back({path + "/" + field.name, field.meaning, field.unit, shape});
    }
  }
  return list;
}

std::vector<Description> sweep_summary_descriptions() {
  std::vector<Description> list{
      {"/", "Means over the seeds of a sweep of runs, with their standard errors", none, none},
      {"/sweep", "Definition of the sweep", none, none},
      {"/sweep/grid", "Grid file as read", none, "scalar"},
      {"/sweep/scene", "Scene that all runs start from", none, "scalar"},
      {"/sweep/version", "Version of the program that made the summary", none, "scalar"},

      {"/parameters", "Keys of the scene that vary between the points of the grid", none, none},
      {"/parameters/*", "Value of this key at each point, as a number or else as text in TOML",
       none, "[points]"},

      {"/members", "Runs that are in the means", none, none},
      {"/members/count", "Number of runs in the means of each point", none, "[points]"},
      {"/members/seeds", "Seed of each run", none, "[members]"},
      {"/members/point", "Point of the grid of each run, counted from 0", none, "[members]"},

      {"/results", "Quantities at the ends of the runs", none, none},
      {"/results/time", "Time since the start of the run", time, none},
      {"/results/collisions_per_needle", "Twice the number of collisions, per needle", none, none},
      {"/results/collision_rate", "Collisions per needle and unit of time, over the whole run",
       "inverse time", none},
      {"/results/energy_ratio", "Energy divided by the energy at the start", none, none},
      {"/results/hits_*", "Hits on this wall", none, none},
      {"/results/impulse_*", "Sum of the magnitudes of the impulses of hits on this wall", momentum,
       none},
      {"/results/pressure_*", "Mean pressure on this wall over the run", "energy per volume", none},
      {"/results/budget_*",
       "Energy per needle that this effect has put in since the start; negative: taken out", energy,
       none},
      {"/results/*/mean", "Mean over the runs of each point", none, "[points]"},
      {"/results/*/standard_error", "Standard error of the mean", none, "[points]"},

      {"/series", "Quantities as functions of time, one group for each point of the grid", none,
       none},
      {"/series/*", "Quantities at the point of this number, as functions of time", none, none},
      {"/series/*/time", "Time of each sample since the start of the run", time, "[samples]"},
  };
  // Those of vectors first.
  Totals::for_each_sum([&](const Described& sum, auto member) {
    const std::string row = dimensions(InFile<ValueOf<decltype(member)>>::shape());
    if (!row.empty()) append(list, means(fmt::format("/series/*/{}", sum.name), row));
  });
  append(list, means("/series/*/*", none));
  append(list, totals("/results", none));
  for (const char* axis : {"x", "y", "z"}) {
    for (const char* side : {"low", "high"}) {
      const std::string wall = fmt::format("_{}_{}", axis, side);
      list.push_back(
          {"/results/hits" + wall,
           fmt::format("Number of hits on the wall at the {} end of the {} axis", side, axis), none,
           none});
      list.push_back({"/results/impulse" + wall,
                      "Sum of the magnitudes of the impulses of these hits", momentum, none});
    }
  }
  append(list, totals("/series/*", none));
  return list;
}

std::vector<Description> vtkhdf_descriptions() {
  return {
      {"/", "Needles as lines, for ParaView and VTK", none, none},
      {"/VTKHDF", "Unstructured grid with one line for each needle", none, none},
      {"/VTKHDF/NumberOfPoints", "Number of points, two for each needle", none, "[1]"},
      {"/VTKHDF/NumberOfCells", "Number of lines", none, "[1]"},
      {"/VTKHDF/NumberOfConnectivityIds", "Length of Connectivity", none, "[1]"},
      {"/VTKHDF/Points", "Ends of the needles: the tail of each, then its tip", length,
       "[points][3]"},
      {"/VTKHDF/Connectivity", "Points that the lines join, two for each", none, "[points]"},
      {"/VTKHDF/Offsets", "Position in Connectivity where each line begins, and its length", none,
       "[needles + 1]"},
      {"/VTKHDF/Types", "VTK type of each cell, 3 for a line", none, "[needles]"},
      {"/VTKHDF/PointData", "Data of the ends of rods", none, none},
      {"/VTKHDF/PointData/radius", "Radius of the rod", length, "[points]"},
      {"/VTKHDF/CellData", "Data of the needles", none, none},
      {"/VTKHDF/CellData/id", "Identity of each needle", none, "[needles]"},
      {"/VTKHDF/CellData/velocity", "Velocity of the centre of each needle", speed, "[needles][3]"},
      {"/VTKHDF/CellData/orientation", "Unit vector along each needle", none, "[needles][3]"},
      {"/VTKHDF/CellData/angular_velocity",
       "Angular velocity of each needle, perpendicular to its orientation but for spheres",
       angular_speed, "[needles][3]"},
  };
}

void write_descriptions(hid_t file, const std::vector<Description>& descriptions,
                        const std::string& place) {
  for (const Description& description : descriptions) {
    const std::string text = sentence(description);
    for (const std::string& path : matches(file, description.path, place)) {
      write_description(file, path, text, place);
      const std::string value = path + "/value";
      if (hdf5::is_group(file, path, place) && hdf5::exists(file, value, place)) {
        write_description(file, value, text, place);
      }
    }
  }
}

}  // namespace needlework::io
