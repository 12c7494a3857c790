// Manual, docs/commands.md and completions, all printed by the program.
#include <fstream>
#include <sstream>

#include "tests/cli/program.h"

namespace needlework {
namespace {

class Reference : public ProgramTest {
 protected:
  std::string printed(const std::string& form) const {
    return output_of("--print-reference " + form);
  }
  bool installed(const std::string& program) const {
    return shell("command -v " + program + " >/dev/null").exit_code == 0;
  }
};

TEST_F(Reference, DocsHoldWhatTheProgramPrints) {
  std::ostringstream committed;
  committed << std::ifstream(NEEDLEWORK_SOURCE "/docs/commands.md").rdbuf();
  EXPECT_EQ(printed("markdown"), committed.str())
      << "build/release/needlework --print-reference markdown >docs/commands.md makes them equal";
}

TEST_F(Reference, KnowsItsForms) {
  EXPECT_TRUE(run("--print-reference html")
                  .fails(3, "--print-reference html: expected man, markdown, bash, zsh or"));
}

TEST_F(Reference, ManualHasAllOptionsAndNoErrors) {
  if (!installed("man")) GTEST_SKIP() << "man is not installed";
  write("needlework.1", printed("man"));
  const Outcome shown = shell("MANWIDTH=80 man --warnings -E UTF-8 -l needlework.1");
  EXPECT_EQ(shown.exit_code, 0);
  EXPECT_EQ(shown.err, "");
  EXPECT_TRUE(contains(shown.out, {"NAME", "EXIT CODES", "NEEDLEWORK SWEEP", "--member K/M",
                                   "needlework run profiles/quickstart.toml", "NEEDLEWORK_ISA"}));
  EXPECT_FALSE(contains(shown.out, "\\f"));
}

struct Completion {
  const char *typed, *offered;
};
constexpr Completion completions[] = {
    {"swe", "sweep"},
    {"run --ou", "--out"},
    {"run --isa avx5", "avx512"},
    {"predict --accuracy r", "rigorous"},
    {"run small.toml --set needles.c", "needles.count="},
    {"run sm", "small.toml"},
    {"info st", "state.h5"},
    {"sweep --out fol", "folder"},
    {"report small.h5 state.t", "state.toml"},
    {"help ch", "check"},
    {"bench qui", "quick"},
};

class ReferenceForShells : public Reference {
 protected:
  // Files and a folder to complete, some of which have another ending than those meant.
  ReferenceForShells() {
    for (const char* name : {"small.h5", "state.h5", "state.toml"}) write(name, "");
    std::filesystem::create_directory(path("folder"));
  }
};

TEST_F(ReferenceForShells, BashCompletes) {
  if (!installed("bash")) GTEST_SKIP() << "bash is not installed";
  write("completion", printed("bash"));
  // As bash calls the function, but for what only works while the user types.
  write("complete", R"(compopt() { :; }
source ./completion
complete -p needlework >/dev/null || exit 1
COMP_WORDS=(needlework "$@")
COMP_CWORD=$#
_needlework
echo "${COMPREPLY[@]%/}"
)");
  for (const Completion& completion : completions) {
    const Outcome outcome = shell(std::string("bash complete ") + completion.typed);
    EXPECT_EQ(outcome.err, "") << completion.typed;
    EXPECT_EQ(outcome.out, completion.offered + std::string("\n")) << completion.typed;
  }
}

TEST_F(ReferenceForShells, ZshCompletes) {
  if (!installed("zsh")) GTEST_SKIP() << "zsh is not installed";
  write("_needlework", printed("zsh"));
  // An interactive shell in which Tab completes and Control-T writes the command line to a file.
  write("complete", R"(zmodload zsh/zpty
zpty shell "zsh -f -i"
zpty -w shell "unset zle_bracketed_paste; fpath=($PWD \$fpath); autoload -Uz compinit"
zpty -w shell "compinit -u -D; unsetopt beep; bindkey '^I' complete-word; bindkey '^T' keep"
zpty -w shell "keep() { print -r -- \"\$BUFFER\" >>$PWD/completed; BUFFER=; zle accept-line }"
zpty -w shell "zle -N keep"
for typed in "$@"; do
  zpty -w -n shell "needlework $typed"$'\t\x14'
done
zpty -w shell exit
while zpty -r shell line; do :; done
)");
  std::string typed, expected;
  for (const Completion& completion : completions) {
    const std::string words = completion.typed;
    typed += " '" + words + "'";
    expected += "needlework " + words.substr(0, words.rfind(' ') + 1) + completion.offered + "\n";
  }
  const Outcome outcome = shell("TERM=dumb timeout 60 zsh -f complete" + typed);
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  const Outcome completed = shell("sed 's:[/ ]*$::' completed");
  EXPECT_EQ(completed.out, expected);
}

// fish offers files of other endings last.
TEST_F(ReferenceForShells, FishCompletes) {
  if (!installed("fish")) GTEST_SKIP() << "fish is not installed";
  write("completion", printed("fish"));
  for (const Completion& completion : completions) {
    const Outcome outcome =
        shell(std::string("{ HOME=$PWD fish --no-config -c 'source ./completion; complete -C \"") +
              "needlework " + completion.typed + "\"' | head -1 | cut -f1 | sed 's:/$::'; }");
    EXPECT_EQ(outcome.err, "") << completion.typed;
    EXPECT_EQ(outcome.out, completion.offered + std::string("\n")) << completion.typed;
  }
}

}  // namespace
}  // namespace needlework
