// Data of a user's own in checkpoints and files.
#include <gtest/gtest.h>

#include <optional>
#include <string>
#include <vector>

#include "needlework/error.h"
#include "needlework/h5md.h"
#include "src/io/contents.h"
#include "src/runs/load_checkpoint.h"
#include "src/runs/prepared_run.h"
#include "src/runs/state_file.h"
#include "tests/runs/silent.h"
#include "tests/support/runs.h"

namespace needlework::runs {
namespace {

using UserDataOfARun = InRunFolder;

const UserData notes{UserData::Kind::json, R"({"text": "wärmer", "n": 3})"};
const UserData generator{UserData::Kind::bytes, std::string("\0\xff\n", 3)};

Scene scene_with(const std::string& file) {
  Scene scene = test::scene_of(20, 5);
  scene.output.file = file;
  return scene;
}

// The values that a file holds, by the rules of docs/file-format.md.
UserDataByName data_in(const std::string& file) {
  const io::Contents contents(file);
  const auto names = contents.texts("/user_data/name").value();
  const auto json = contents.numbers("/user_data/json"),
             begin = contents.numbers("/user_data/begin"),
             size = contents.numbers("/user_data/size");
  const auto bytes = contents.numbers("/user_data/bytes");
  UserDataByName data;
  for (std::size_t n = 0; n < names.size(); ++n) {
    data.erase(names[n]);
    if (size[n] < 0) continue;
    const auto first = bytes.begin() + static_cast<std::ptrdiff_t>(begin[n]);
    data[names[n]] = {json[n] == 1 ? UserData::Kind::json : UserData::Kind::bytes,
                      std::string(first, first + static_cast<std::ptrdiff_t>(size[n]))};
  }
  return data;
}

TEST_F(UserDataOfARun, IsInItsFileAndInTheStateThatItWrites) {
  const std::string state = folder.path() / "state.h5";
  PreparedRun run(complete_scene(scene_with(file)), false);
  run.set_data("notes", UserData{UserData::Kind::bytes, "first"});
  run.set_data("generator", generator);
  run.set_data("generator", generator);  // the same again takes no room
  run.set_data("notes", notes);
  run.set_data("gone", notes);
  run.set_data("gone", std::nullopt);
  run.set_data("never", std::nullopt);
  write_state(run.simulation(), run.scene(), run.data(), state, false);
  run.close();
  const UserDataByName expected{{"notes", notes}, {"generator", generator}};
  EXPECT_EQ(data_in(file), expected);
  EXPECT_EQ(data_in(state), expected);
  EXPECT_EQ(io::Contents(file).shape("/user_data/size").at(0), 5u);
}

TEST_F(UserDataOfARun, ComesBackWithItsCheckpoint) {
  {
    PreparedRun run(complete_scene(scene_with(file)), false);
    run.set_data("notes", notes);
    run.set_data("generator", generator);
    run.save_checkpoint();
    run.set_data("notes", std::nullopt);  // which the checkpoint does not know
  }
  PreparedRun run(load_checkpoint(file).checkpoint);
  EXPECT_EQ(run.data(), (UserDataByName{{"notes", notes}, {"generator", generator}}));
  run.set_data("generator", notes);
  run.close();
  EXPECT_EQ(data_in(file), (UserDataByName{{"notes", notes}, {"generator", notes}}));
}

TEST_F(UserDataOfARun, IsRefusedIfItCannotBeCarried) {
  PreparedRun run(complete_scene(scene_with("")), false);
  for (const std::string& name :
       {std::string(), std::string(65, 'x'), std::string("a\nb"), std::string("\xff")}) {
    EXPECT_THROW(run.set_data(name, notes), InputError) << name;
  }
  EXPECT_THROW(run.set_data("notes", UserData{UserData::Kind::json, "{\"a\": }"}), InputError);
  EXPECT_THROW(
      run.set_data("notes", UserData{UserData::Kind::bytes, std::string(longest_data + 1, 'x')}),
      InputError);
  EXPECT_TRUE(run.data().empty());
  run.set_data(std::string(64, 'x'), UserData{UserData::Kind::bytes, ""});
  EXPECT_EQ(run.data().size(), 1u);
}

}  // namespace
}  // namespace needlework::runs
