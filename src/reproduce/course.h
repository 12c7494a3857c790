// How runs go on in time, counted in collisions and in scaled time, and means over seeds.
#pragma once

#include <functional>
#include <span>
#include <string>
#include <vector>

#include "needlework/h5md.h"
#include "src/reproduce/figure.h"
#include "src/reproduce/paper_runs.h"

namespace needlework::reproduce {

/// tau / t = gamma sqrt(T_tr(0)), where gamma = (2/3) sqrt(pi) n in units of L and m.
double time_scale(const Scene& scene);

/// Scaled times of the samples.
std::vector<double> taus_of(const FinishedRun& run);

/// Collisions per needle, 2 collisions / N, at the samples.
std::vector<double> collisions_of(const FinishedRun& run);

/// y at a place between those of x, which increase; linear between samples, NaN outside.
double interpolated(std::span<const double> x, std::span<const double> y, double place);

/// The sample nearest to so many collisions per needle.
std::size_t sample_near(const FinishedRun& run, double collisions);

/// The frame of the file of a run nearest to so many collisions per needle.
std::size_t frame_near(const FinishedRun& run, const io::FrameFile& frames, double collisions);

/// The mean over seeds, with its standard error.
Measured mean_of(std::span<const double> values);

/// Of each run of a point a number, and the mean of these.
Measured measure(const Point& point, const std::function<double(const FinishedRun&)>& number);

/// A mean over seeds as a function of something.
struct MeanCurve {
  std::vector<double> x, mean, error;
};

/// Means at these places of curves that each run has.
MeanCurve mean_curve(
    const Point& point, std::span<const double> places,
    const std::function<std::pair<std::vector<double>, std::vector<double>>(const FinishedRun&)>&
        curve);

/// Equal steps from `first` to `last`.
std::vector<double> steps(double first, double last, std::size_t count);

/// "k = 6, T_rot(0) = 1".
std::string start_of(const Scene& scene);
/// The same for charts, with letters below the line.
std::string start_in_chart(const Scene& scene);

}  // namespace needlework::reproduce
