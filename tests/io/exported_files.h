// A folder of exported files.
#pragma once

#include <algorithm>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "src/io/formats/export_formats.h"
#include "src/io/formats/read_configuration.h"
#include "tests/io/complaints.h"
#include "tests/io/support.h"
#include "tests/support/whole_file.h"

namespace needlework::io {

inline const Material material{.names = {"needles"},
                               .length = {1.7},
                               .mass = {2.5},
                               .k = {3.3},
                               .epsilon = {0.9},
                               .beta = {-0.25}};

// A dump of LAMMPS of one frame; `boxes` are the bounds along each axis.
inline std::string lammps_dump(int atoms, const std::string& columns, const std::string& rows,
                               const std::string& boundary = "pp pp pp",
                               const std::string& boxes = "0 8\n0 8\n0 8\n") {
  return "ITEM: TIMESTEP\n7\nITEM: NUMBER OF ATOMS\n" + std::to_string(atoms) +
         "\nITEM: BOX BOUNDS " + boundary + "\n" + boxes + "ITEM: ATOMS " + columns + "\n" + rows;
}

class Formats : public InFolder {
 protected:
  // Writes these frames under the name, in the format that its ending means.
  std::string put(const std::string& name, const std::vector<State>& states,
                  const Material& of = material) const {
    const ExportFormat* format = find_export_format("", name, false);
    const auto writer = format->open(file(name), true, of);
    for (std::size_t i = 0; i < states.size(); ++i) {
      writer->add({i, 0.1 * static_cast<double>(i), states[i]});
    }
    writer->publish();
    return file(name);
  }
  std::string text_of_file(const std::string& name) const { return test::bytes_of(file(name)); }
  std::string complaint(const std::string& text) const {
    std::ofstream(file("bad"), std::ios::binary) << text;
    const std::string message = message_of<InputError>([&] { read_configuration(file("bad")); });
    EXPECT_TRUE(message.starts_with(file("bad") + ": ")) << message;
    return message.substr(std::min(message.size(), file("bad").size() + 2));
  }
};

// Exports have no empty lists of ids and images.
inline State completed(State state, bool with_images) {
  state.image.resize(with_images ? state.size() : 0);
  if (state.id.empty()) {
    for (std::uint32_t i = 0; i < state.size(); ++i) state.id.push_back(i);
  }
  return state;
}

}  // namespace needlework::io
