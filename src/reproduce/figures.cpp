#include <algorithm>

#include "src/reproduce/all_figures.h"
#include "src/reproduce/figure.h"

namespace needlework::reproduce {
namespace {

const Figure all[] = {
    {"2", "Figure 2: cooling of the dilute gas", {"dilute"}, make_cooling},
    {"3", "Figure 3: long-time ratio of temperatures", {"ratio"}, make_ratio},
    {"4", "Figure 4: flow field of the dense gas", {"dense"}, make_flow_field},
    {"5a", "Figure 5a: order of the flow S", {"dense"}, make_flow_order},
    {"5b", "Figure 5b: cooling of the dense gas", {"dense"}, make_dense_cooling},
    {"6", "Figure 6: regions of higher density", {"dense"}, make_density_map},
    {"7", "Figure 7: flow and density along a line", {"dense"}, make_line_profiles},
    {"8", "Figure 8: directors and velocities", {"dense"}, make_alignment},
    {"fluctuations",
     "Fluctuations of the dilute gas beside an elastic one",
     {"dilute", "elastic"},
     make_fluctuations},
    {"moment", "Second moment of the density of the dense gas", {"dense"}, make_second_moment},
    {"rotation", "Order of the rotation of the dense gas", {"dense"}, make_rotation},
    {"relaxation", "Elastic relaxation to equipartition", {"relaxation"}, make_relaxation},
    {"rough", "Beyond the paper: long-time ratio of rough needles", {"rough"}, make_rough_ratio},
    {"sizes",
     "Beyond the paper: the dense gas in boxes of several sizes",
     {"box-small", "box-middle", "box-large", "dense"},
     make_box_sizes},
    {"clusters", "Beyond the paper: alignment inside clusters", {"dense"}, make_clusters},
    {"cells", "Test of why: size of the cells", {"dense"}, make_cells},
    {"tc-dilute",
     "Test of why: contact time of the dilute gas",
     {"dilute", "dilute-tc"},
     make_contact_time_dilute},
    {"tc-dense",
     "Test of why: contact time of the dense gas",
     {"dense", "dense-tc"},
     make_contact_time_dense},
};

}  // namespace

std::span<const Figure> figures() { return all; }

const Figure* find_figure(std::string_view name) {
  const auto found = std::find_if(std::begin(all), std::end(all),
                                  [&](const Figure& figure) { return figure.name == name; });
  return found == std::end(all) ? nullptr : &*found;
}

}  // namespace needlework::reproduce
