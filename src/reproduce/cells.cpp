#include "src/reproduce/cells.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>

#include "src/reproduce/course.h"

namespace needlework::reproduce {

std::vector<double> CellFields::edges(std::size_t axis) const {
  return steps(0, box[axis], cells[axis]);
}

CellFields cell_fields(const FinishedRun& run, std::size_t sample) {
  const io::RecordedField density = run.field("fields/density"), flow = run.field("fields/flow");
  CellFields fields;
  for (std::size_t axis = 0; axis < 3; ++axis) fields.cells[axis] = density.shape.at(axis);
  fields.box = run.scene->needles.box;
  fields.collisions = collisions_of(run).at(sample);
  fields.t_tr = run.series.at(sample).t_tr;
  const auto rho = density.row(sample), u = flow.row(sample);
  double mean = 0;
  for (const double x : rho) mean += x / static_cast<double>(rho.size());
  for (std::size_t cell = 0; cell < rho.size(); ++cell) {
    fields.excess.push_back(rho[cell] / mean - 1);
    fields.flow.push_back({u[3 * cell], u[3 * cell + 1], u[3 * cell + 2]});
  }
  return fields;
}

ShearWave strongest_shear_wave(const CellFields& fields) {
  double total = 0;
  for (const auto& u : fields.flow) total += u[0] * u[0] + u[1] * u[1] + u[2] * u[2];
  total /= static_cast<double>(fields.flow.size());

  ShearWave best;
  for (std::size_t gradient = 0; gradient < 3; ++gradient) {
    const std::size_t slabs = fields.cells[gradient];
    std::vector<std::array<double, 3>> means(slabs);
    for_each_cell(fields.cells, [&](const std::array<std::size_t, 3>& place) {
      const auto& u = fields.flow[fields.index(place)];
      const double per_slab = static_cast<double>(slabs) / static_cast<double>(fields.flow.size());
      for (std::size_t a = 0; a < 3; ++a) means[place[gradient]][a] += u[a] * per_slab;
    });
    for (std::size_t along = 0; along < 3; ++along) {
      if (along == gradient) continue;
      for (std::size_t number = 1; number <= slabs / 2; ++number) {
        std::complex<double> amplitude = 0;
        for (std::size_t slab = 0; slab < slabs; ++slab) {
          const double angle = 2 * std::numbers::pi * static_cast<double>(number * slab) /
                               static_cast<double>(slabs);
          amplitude += means[slab][along] * std::polar(1 / static_cast<double>(slabs), angle);
        }
        // Two waves, n and -n, but for the shortest one.
        const double energy = (2 * number == slabs ? 1 : 2) * std::norm(amplitude);
        if (energy > best.share * total) best = {gradient, along, number, energy / total};
      }
    }
  }
  return best;
}

double dense_share(const CellFields& fields) {
  const auto dense = std::count_if(fields.excess.begin(), fields.excess.end(),
                                   [](double excess) { return excess > dense_excess; });
  return static_cast<double>(dense) / static_cast<double>(fields.excess.size());
}

double density_flow_correlation(const CellFields& fields) {
  const double n = static_cast<double>(fields.flow.size());
  double su = 0, suu = 0, see = 0, sue = 0;
  for (std::size_t cell = 0; cell < fields.flow.size(); ++cell) {
    const auto& u = fields.flow[cell];
    const double u2 = u[0] * u[0] + u[1] * u[1] + u[2] * u[2], e = fields.excess[cell];
    su += u2, suu += u2 * u2, see += e * e, sue += u2 * e;
  }
  return sue / std::sqrt((suu - su * su / n) * see);  // the mean of the excess is 0
}

}  // namespace needlework::reproduce
