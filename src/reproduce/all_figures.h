// The functions that make the figures, each group in a file of its own.
#pragma once

#include "src/reproduce/figure.h"

namespace needlework::reproduce {

// dilute_figures.cpp
FigureResult make_cooling(const PaperRuns& runs);
// fluctuations_figure.cpp
FigureResult make_fluctuations(const PaperRuns& runs);
// ratio_figures.cpp
FigureResult make_ratio(const PaperRuns& runs);
FigureResult make_rough_ratio(const PaperRuns& runs);
FigureResult make_relaxation(const PaperRuns& runs);
// flow_figures.cpp
FigureResult make_flow_field(const PaperRuns& runs);
FigureResult make_density_map(const PaperRuns& runs);
FigureResult make_line_profiles(const PaperRuns& runs);
// dense_figures.cpp
FigureResult make_flow_order(const PaperRuns& runs);
FigureResult make_dense_cooling(const PaperRuns& runs);
FigureResult make_second_moment(const PaperRuns& runs);
FigureResult make_rotation(const PaperRuns& runs);
FigureResult make_box_sizes(const PaperRuns& runs);
// alignment_figures.cpp
FigureResult make_alignment(const PaperRuns& runs);
FigureResult make_clusters(const PaperRuns& runs);
// why_figures.cpp
FigureResult make_cells(const PaperRuns& runs);
FigureResult make_contact_time_dilute(const PaperRuns& runs);
FigureResult make_contact_time_dense(const PaperRuns& runs);

}  // namespace needlework::reproduce
