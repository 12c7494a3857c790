// What the compiler made of the library: no fused multiply-add and no approximation outside the
// filters, which alone may round differently from machine to machine, and registers as wide as each
// instruction set has them.
#include <gtest/gtest.h>
#include <stdio.h>

#include <map>
#include <memory>
#include <regex>
#include <string>
#include <string_view>

namespace needlework {
namespace {

/// Calls visit(object, symbol, instruction) for all of the library.
template <class Visit>
void disassemble(Visit&& visit) {
  const std::string command =
      std::string(NEEDLEWORK_OBJDUMP) + " -d --no-show-raw-insn " + NEEDLEWORK_LIBRARY;
  const auto close = [](FILE* file) { EXPECT_EQ(pclose(file), 0); };
  const std::unique_ptr<FILE, decltype(close)> pipe(popen(command.c_str(), "r"), close);
  ASSERT_TRUE(pipe) << command;
  std::string object, symbol;
  char buffer[4096];
  while (fgets(buffer, sizeof buffer, pipe.get())) {
    const std::string_view line(buffer);
    if (line.front() != ' ') {
      // 0000000000000000 <symbol>:
      const auto begin = line.find('<'), end = line.rfind(">:");
      if (begin != line.npos && end != line.npos) symbol = line.substr(begin + 1, end - begin - 1);
      // near_needles.cpp.o:     file format elf64-x86-64
      if (const auto format = line.find(":     file format"); format != line.npos) {
        object = line.substr(0, format);
      }
    } else if (const auto tab = line.find('\t'); tab != line.npos) {
      visit(object, symbol, line.substr(tab + 1));
    }
  }
}

bool is(std::string_view instruction, const std::regex& pattern) {
  const auto mnemonic = instruction.substr(0, instruction.find_first_of(" \t\n"));
  return std::regex_match(mnemonic.begin(), mnemonic.end(), pattern);
}

bool is_fused(std::string_view instruction) {
  // vfmadd132sd, vfnmsub231ps, vfmaddsub213pd, and vfmaddss of four operands.
  static const std::regex pattern("vfn?m(add|sub).*");
  return is(instruction, pattern);
}

/// Reciprocals and their roots, which differ between processors.
bool is_approximate(std::string_view instruction) {
  // rcpps, vrsqrtss, vrcp14ps, vrsqrt28sd; but the letters of rcr or sqrtps are none.
  static const std::regex pattern("v?r(cp|sqrt)[0-9]*[ps][sd]");
  return is(instruction, pattern);
}

bool is_in_single_precision(std::string_view instruction) {
  static const std::regex pattern(".*[ps]s");
  return is(instruction, pattern);
}

/// Functions of near_kernels() for an instruction set; newer versions of Highway build them for
/// SSE2, too, which nobody calls.
bool is_of_a_filter(const std::string& object, const std::string& symbol) {
  static const std::regex target("_Z.*10needlework7kernels6N_(SSE2|SSE4|AVX2|AVX3).*");
  return object.find("near_needles.cpp") != object.npos && std::regex_match(symbol, target);
}

TEST(MachineCode, IsRecognised) {
  for (const char* fused : {"vfmadd132sd %xmm0,%xmm1,%xmm2", "vfnmadd231ps (%rax),%zmm1,%zmm2",
                            "vfmsub213pd %ymm0,%ymm1,%ymm2", "vfmaddsub132ps %xmm0,%xmm1,%xmm2",
                            "vfnmsub132ss %xmm0,%xmm1,%xmm2\n"}) {
    EXPECT_TRUE(is_fused(fused)) << fused;
  }
  EXPECT_TRUE(is_in_single_precision("vfmadd132ss %xmm0,%xmm1,%xmm2"));
  EXPECT_TRUE(is_in_single_precision("vfnmadd231ps (%rax),%zmm1,%zmm2"));
  EXPECT_FALSE(is_in_single_precision("vfmadd132sd %xmm0,%xmm1,%xmm2"));
  EXPECT_FALSE(is_in_single_precision("vfmsub213pd %ymm0,%ymm1,%ymm2"));
  for (const char* rough : {"rcpps %xmm0,%xmm1", "vrsqrtss %xmm0,%xmm1,%xmm2",
                            "vrcp14ps %zmm0,%zmm1", "vrsqrt14pd %zmm0,%zmm1\n"}) {
    EXPECT_TRUE(is_approximate(rough)) << rough;
  }
  for (const char* exact : {"vsqrtps %zmm0,%zmm1", "rcr %rax", "divss %xmm0,%xmm1"}) {
    EXPECT_FALSE(is_approximate(exact)) << exact;
  }
  EXPECT_TRUE(is_of_a_filter("near_needles.cpp.o", "_ZN10needlework7kernels6N_AVX211overlappingE"));
  EXPECT_FALSE(is_of_a_filter("near_needles.cpp.o", "_ZN10needlework7kernels6scalar7bracketE"));
  EXPECT_FALSE(is_of_a_filter("free_flight.cpp.o", "_ZN10needlework7kernels6N_AVX23flyE"));
  for (const char* plain : {"vmulps %zmm0,%zmm1,%zmm2", "vaddsd %xmm0,%xmm1,%xmm2", "ret"}) {
    EXPECT_FALSE(is_fused(plain)) << plain;
  }
}

TEST(MachineCode, RoundsDifferentlyInFiltersAlone) {
  std::size_t multiplications = 0, fused = 0, approximate = 0, elsewhere = 0;
  std::string first;
  disassemble(
      [&](const std::string& object, const std::string& symbol, std::string_view instruction) {
        multiplications += instruction.find("mul") < 2;
        const bool is_one = is_fused(instruction);
        if (!is_one && !is_approximate(instruction)) return;
        ++(is_one ? fused : approximate);
        if (is_of_a_filter(object, symbol) && is_in_single_precision(instruction)) return;
        if (++elsewhere == 1) first = object + ": " + symbol + ": " + std::string(instruction);
      });
#if defined(__x86_64__)
  EXPECT_GT(multiplications, 1000u) << "nothing was read";
  EXPECT_GT(fused, 100u) << "filters of AVX2 and AVX-512 have them";
  EXPECT_GT(approximate, 10u) << "filters have them";
#else
  GTEST_SKIP() << "the names of instructions are those of x86";
#endif
  EXPECT_EQ(elsewhere, 0u) << first;
}

// The namespaces of Highway's targets are part of the symbols. Compilers may pair two scalars, such
// as squares of the needle's own that all lanes share, in one packed operation of the least width.
TEST(MachineCode, OfSimdUsesTheRegistersOfItsInstructionSet) {
#if !defined(__x86_64__)
  GTEST_SKIP() << "the names of registers are those of x86";
#endif
  struct Widths {
    std::size_t xmm = 0, ymm = 0, zmm = 0;
  };
  std::map<std::string, Widths> arithmetic;  // by target, of packed numbers
  const std::regex packed("v?(add|sub|mul|div|sqrt|min|max|fn?m(add|sub)[0-9]*)p[sd]");
  disassemble([&](const std::string&, const std::string& symbol, std::string_view instruction) {
    const auto end = instruction.find_first_of(" \t\n");
    if (!std::regex_match(instruction.begin(), instruction.begin() + end, packed)) return;
    for (const char* target : {"N_SSE4", "N_AVX2", "N_AVX3"}) {
      if (symbol.find(target) == symbol.npos) continue;
      Widths& widths = arithmetic[target];
      widths.xmm += instruction.find("%xmm") != instruction.npos;
      widths.ymm += instruction.find("%ymm") != instruction.npos;
      widths.zmm += instruction.find("%zmm") != instruction.npos;
    }
  });
  const auto& sse4 = arithmetic["N_SSE4"];
  EXPECT_GT(sse4.xmm, 100u);
  EXPECT_EQ(sse4.ymm + sse4.zmm, 0u);
  const auto& avx2 = arithmetic["N_AVX2"];
  EXPECT_GT(avx2.ymm, 100u);
  EXPECT_EQ(avx2.zmm, 0u);
  EXPECT_LT(avx2.xmm, avx2.ymm / 50);
  const auto& avx512 = arithmetic["N_AVX3"];
  EXPECT_GT(avx512.zmm, 100u);
  EXPECT_EQ(avx512.ymm, 0u);
  EXPECT_LT(avx512.xmm, avx512.zmm / 50);
}

}  // namespace
}  // namespace needlework
