// The structure factor S(k) = |sum over needles of exp(i k . r)|^2 / N for the wave vectors
// k = 2 pi n / edge, n = 1 to 16, along each axis of the box, with the edges of the instant. For
// independent positions it is exponentially distributed with mean 1. An n-fold density wave along
// an axis is a peak of the order of N there. Where rows of boxes slide by D along x, wave vectors
// are those of the lattice of the instant: along x, of those with k_x = 2 pi n / edge that with the
// least part along y, k_y = 2 pi (m - n D / edge) / (edge along y) for an integer m. With several
// species, of each two of them S_ab(k) = Re(rho_a rho_b*) / sqrt(N_a N_b), rho_a the sum over the
// needles of a; independent species have mean 0 for a and b.
#include <cmath>
#include <complex>
#include <numbers>

#include "src/observe/registry.h"

namespace needlework::observe {
namespace {

constexpr std::size_t waves = 16;

class StructureFactor : public Observable {
 public:
  explicit StructureFactor(const GasSetting& gas) : gas_(gas) {}

  std::vector<SeriesField> fields() const override {
    std::vector<SeriesField> out{
        {"s", "Structure factor at wave vectors along each axis", unit::none,
         by_pair(gas_.composition, {{"3", 3}, {"waves", waves}})},
        {"k", "Wave numbers along each axis", unit::wave_number, {{"3", 3}, {"waves", waves}}},
    };
    if (!gas_.moving_edges) {
      out.back().kind = SeriesField::Kind::constant;
      out.back().values = wave_numbers(gas_.box.edges());
    }
    if (gas_.is_sheared) {
      out.push_back({"k_y",
                     "In a flow, part along y of the wave vectors along x",
                     unit::wave_number,
                     {{"waves", waves}}});
    }
    return out;
  }

  void sample(const Snapshot& now, Row& row) override {
    using Complex = std::complex<double>;
    using Sums = std::array<std::array<Complex, waves>, 3>;
    const Composition& composition = gas_.composition;
    const Tilted tilted(box_of(now.state));
    std::vector<Sums> by_species(composition.size());
    for (std::size_t i = 0; i < now.state.size(); ++i) {
      const Vector& r = now.state.position[i];
      Sums& sums = by_species[composition.is_mixture() ? now.state.species[i] : 0];
      if (gas_.is_sheared) {
        for (std::size_t n = 0; n < waves; ++n) sums[0][n] += std::polar(1.0, tilted.phase(n, r));
      }
      for (std::size_t axis = gas_.is_sheared ? 1 : 0; axis < 3; ++axis) {
        const double phase = 2 * std::numbers::pi * (r[axis] / now.edges()[axis]);
        const Complex first(std::cos(phase), std::sin(phase));
        Complex wave = first;
        for (Complex& sum : sums[axis]) {
          sum += wave;
          // Written out, as the operator of the library looks for NaN.
          wave = {wave.real() * first.real() - wave.imag() * first.imag(),
                  wave.real() * first.imag() + wave.imag() * first.real()};
        }
      }
    }
    for (std::size_t a = 0; a < composition.size(); ++a) {
      for (std::size_t b = a; b < composition.size(); ++b) {
        const double first = static_cast<double>(composition[a].count);
        const double count =
            a == b ? first : std::sqrt(first * static_cast<double>(composition[b].count));
        for (std::size_t axis = 0; axis < 3; ++axis) {
          for (std::size_t n = 0; n < waves; ++n) {
            const Complex& one = by_species[a][axis][n];
            const Complex& other = by_species[b][axis][n];
            row.put((one.real() * other.real() + one.imag() * other.imag()) / count);
          }
        }
      }
    }
    if (gas_.moving_edges) row.put_all(wave_numbers(now.edges()));
    if (gas_.is_sheared) row.put_all(tilted.along_y);
  }

 private:
  static std::vector<double> wave_numbers(const Vector& edges) {
    std::vector<double> out;
    for (const double edge : edges)
      for (std::size_t n = 1; n <= waves; ++n)
        out.push_back(2 * std::numbers::pi * double(n) / edge);
    return out;
  }

  // The wave vectors along x of a lattice whose rows have slid.
  struct Tilted {
    explicit Tilted(const Box& box) {
      const double slide = box.vectors()[1][0] / box.edge(0);
      for (std::size_t n = 0; n < waves; ++n) {
        const double boxes = double(n + 1) * slide;
        along_x[n] = 2 * std::numbers::pi * double(n + 1) / box.edge(0);
        along_y[n] = 2 * std::numbers::pi * (std::nearbyint(boxes) - boxes) / box.edge(1);
      }
    }
    double phase(std::size_t n, const Vector& r) const {
      return along_x[n] * r[0] + along_y[n] * r[1];
    }

    std::array<double, waves> along_x, along_y;
  };

  GasSetting gas_;
};

}  // namespace

ObservablePointer make_structure_factor(const GasSetting& gas) {
  return std::make_unique<StructureFactor>(gas);
}

}  // namespace needlework::observe
