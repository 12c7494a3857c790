#include "bench/kernels/neighbourhood.h"

#include <algorithm>
#include <cmath>

#include "needlework/initial_state.h"
#include "needlework/simulation.h"
#include "src/search/choice.h"

namespace needlework::bench {
namespace {

using kernels::Flight;
using kernels::Motion;
using kernels::NeedleBlock;
using kernels::Seeker;

constexpr std::uint64_t needles_drawn = 4000;
// More than the engine's searches take as margin in such boxes.
constexpr float margin = 0x1p-14f;

Vec3d vector(const std::array<double, 3>& a) { return {a[0], a[1], a[2]}; }

void store(float (&to)[3], const Vec3d& a) {
  to[0] = static_cast<float>(a.x);
  to[1] = static_cast<float>(a.y);
  to[2] = static_cast<float>(a.z);
}

std::vector<Flight> draw(double density, double& box) {
  Scene scene;
  scene.needles.count = needles_drawn;
  box = std::cbrt(static_cast<double>(needles_drawn) / density);
  scene.needles.box = {box, box, box};
  const State state = draw_initial_state(scene);
  std::vector<Flight> out(state.size());
  for (std::size_t i = 0; i < state.size(); ++i) {
    out[i].r = vector(state.position[i]);
    out[i].v = vector(state.velocity[i]);
    out[i].u = vector(state.orientation[i]);
    out[i].w = vector(state.angular_velocity[i]);
    set_rotation(out[i]);
  }
  return out;
}

double nearest_image(double d, double box) { return d - box * std::round(d / box); }

/// Whether the bounding spheres overlap at some time in [0, ahead].
bool spheres_meet(const Vec3d& r, const Vec3d& v, double ahead) {
  const double a = dot(v, v), b = dot(r, v);
  const double s = std::clamp(-b / a, 0.0, ahead);
  const Vec3d nearest = r + v * s;
  return dot(nearest, nearest) < 1;
}

Motion motion_of(const Flight& flight, const Vec3d& corner) {
  Motion out{};
  store(out.r, flight.r - corner);
  store(out.v, flight.v);
  store(out.u, flight.u);
  store(out.p, flight.p);
  out.omega = static_cast<float>(flight.omega);
  out.half = 0.5f;
  return out;
}

Seeker seeker_of(const Motion& motion, double ahead, std::uint32_t needle) {
  Seeker out{};
  out.motion = motion;
  std::copy(std::begin(motion.r), std::end(motion.r), out.r);
  std::copy(std::begin(motion.u), std::end(motion.u), out.u);
  out.ahead = static_cast<float>(ahead);
  out.margin = margin;
  out.longest_half = 0.5f;
  out.needle = needle;
  return out;
}

}  // namespace

// A needle of T = 1 and k = 6 collides 1.24 n times in a unit of time: six tenths of the mean free
// time, as searches are cut where a needle leaves its cell.
double time_ahead(double density) { return 1 / (2.1 * density); }

namespace {

/// The pairs of this needle, which comes first in each.
std::vector<NearPair> pairs_of(const Flight& first, const std::vector<Flight>& needles, double box,
                               double ahead) {
  std::vector<NearPair> out;
  for (const Flight& second : needles) {
    if (&first == &second) continue;
    const Vec3d d = first.r - second.r;
    const Vec3d r{nearest_image(d.x, box), nearest_image(d.y, box), nearest_image(d.z, box)};
    if (!spheres_meet(r, first.v - second.v, ahead)) continue;
    out.push_back({first, second});
    out.back().second.r = first.r - r;
  }
  return out;
}

}  // namespace

std::vector<NearPair> near_pairs(double density, std::size_t count) {
  double box = 0;
  const std::vector<Flight> needles = draw(density, box);
  std::vector<NearPair> out;
  for (const Flight& needle : needles) {
    if (out.size() >= count) break;
    const std::vector<NearPair> its = pairs_of(needle, needles, box, time_ahead(density));
    out.insert(out.end(), its.begin(), its.end());
  }
  out.resize(std::min(out.size(), count));
  return out;
}

Neighbourhoods::Neighbourhoods(double density, Columns columns, std::size_t count) {
  double box = 0;
  const std::vector<Flight> needles = draw(density, box);
  const double least_side =
      columns == Columns::directors ? auto_side_for_capsules(density) : auto_cell_side(density);
  const int cells = std::max(1, static_cast<int>(box / least_side));
  const double side = box / cells;
  const auto cell_of = [&](const Vec3d& r, int axis) {
    const double c = std::floor(component(r, axis) / side);
    return std::clamp(static_cast<int>(c), 0, cells - 1);
  };
  const auto corner_of = [&](const Vec3d& r) {
    return Vec3d{cell_of(r, 0) * side, cell_of(r, 1) * side, cell_of(r, 2) * side};
  };

  format = kernels::WordFormat::holding(0, side);
  blocks.resize(static_cast<std::size_t>(cells) * cells * cells);
  next.resize(blocks.size(), NeedleBlock::none);
  for (std::uint32_t i = 0; i < needles.size(); ++i) {
    const Flight& needle = needles[i];
    std::uint32_t b =
        (cell_of(needle.r, 2) * cells + cell_of(needle.r, 1)) * cells + cell_of(needle.r, 0);
    while (blocks[b].is_full()) {
      if (next[b] == NeedleBlock::none) {
        next[b] = static_cast<std::uint32_t>(blocks.size());
        blocks.emplace_back();
        next.push_back(NeedleBlock::none);
      }
      b = next[b];
    }
    const std::uint32_t lane = blocks[b].size();
    const Vec3d r = needle.r - corner_of(needle.r);
    const Vec3d& a = columns == Columns::directors ? needle.u : needle.v;
    for (int axis = 0; axis < 3; ++axis) {
      const double place = component(r, axis);
      blocks[b].word[axis][lane] = columns == Columns::directors
                                       ? format.with_director(place, component(a, axis))
                                       : format.with_velocity(place, component(a, axis));
    }
    blocks[b].needle[lane] = i;
  }

  const bool capsules = columns == Columns::directors;
  const double ahead = time_ahead(density);
  const double reach = capsules ? 0.5 + 2 * auto_capsule_radius(density) : 1;
  for (std::uint32_t i = 0; i < count && i < needles.size(); ++i) {
    const Flight& needle = needles[i];
    const Vec3d corner = corner_of(needle.r);
    Neighbourhood one;
    one.seeker = seeker_of(motion_of(needle, corner), ahead, i);
    const Vec3d half_way = capsules ? needle.u * 0.5 : needle.v * ahead;
    for (int z = 0; z < cells; ++z) {
      for (int y = 0; y < cells; ++y) {
        for (int x = 0; x < cells; ++x) {
          const int cell[3] = {x, y, z};
          double gap_squared = 0, offset[3];
          for (int axis = 0; axis < 3; ++axis) {
            const double r = component(needle.r, axis), way = component(half_way, axis);
            const double centre = (cell[axis] + 0.5) * side;
            const double apart = nearest_image(centre - r, box);
            offset[axis] = r + apart - 0.5 * side - component(corner, axis);
            const double low = std::min(capsules ? -way : 0, way),
                         high = std::max(capsules ? -way : 0, way);
            const double gap =
                std::max({0.0, apart - 0.5 * side - high, low - (apart + 0.5 * side)});
            gap_squared += gap * gap;
          }
          if (gap_squared > reach * reach) continue;
          const std::uint32_t first = (z * cells + y) * cells + x;
          one.cells.push_back({first,
                               {static_cast<float>(offset[0]), static_cast<float>(offset[1]),
                                static_cast<float>(offset[2])}});
          for (std::uint32_t b = first; b != NeedleBlock::none; b = next[b]) {
            one.needles += blocks[b].size();
          }
        }
      }
    }
    most_needles = std::max(most_needles, one.needles);
    all.push_back(std::move(one));
  }
}

PairBatch::PairBatch(const std::vector<NearPair>& pairs, double time_ahead)
    : size(pairs.size()),
      // Kernels work on whole blocks, and may use some more.
      room_((pairs.size() / kernels::block_size + 4) * kernels::block_size),
      storage_(room_ * kernels::PairColumns::columns) {
  using C = kernels::PairColumns;
  seeker = seeker_of(motion_of(pairs.front().first, pairs.front().first.r), time_ahead, 0);
  const kernels::PairColumns to = columns();
  for (std::size_t n = 0; n < pairs.size(); ++n) {
    const Flight &first = pairs[n].first, &second = pairs[n].second;
    const Vec3d r = first.r - second.r, v = first.v - second.v;
    for (int axis = 0; axis < 3; ++axis) {
      to.column[C::r_x + axis][n] = static_cast<float>(component(r, axis));
      to.column[C::v_x + axis][n] = static_cast<float>(component(v, axis));
      to.column[C::u_x + axis][n] = static_cast<float>(component(second.u, axis));
      to.column[C::p_x + axis][n] = static_cast<float>(component(second.p, axis));
    }
    to.column[C::omega][n] = static_cast<float>(second.omega);
    to.column[C::half][n] = 0.5f;
    to.column[C::until][n] = seeker.ahead;
  }
}

kernels::PairColumns PairBatch::columns() {
  kernels::PairColumns out;
  for (int c = 0; c < kernels::PairColumns::columns; ++c) {
    out.column[c] = storage_.data() + c * room_;
  }
  return out;
}

void PairBatch::restart() {
  float* from = columns().column[kernels::PairColumns::from];
  std::fill(from, from + size, 0.0f);
}

std::vector<PairBatch> pair_batches(double density, std::size_t count) {
  double box = 0;
  const double ahead = time_ahead(density);
  const std::vector<Flight> needles = draw(density, box);
  std::vector<PairBatch> out;
  for (std::size_t i = 0; i < needles.size() && out.size() < count; ++i) {
    const std::vector<NearPair> its = pairs_of(needles[i], needles, box, ahead);
    if (!its.empty()) out.emplace_back(its, ahead);
  }
  return out;
}

}  // namespace needlework::bench
