// SIMD kernels that find, among many needles, those that one needle may meet soon.
//
// They work in float on compact copies of the records and only ever rule pairs out, with margins
// that cover every rounding. So no choice of kernel or instruction set can change a trajectory.
// Pairs that are not ruled out go to first_contact(), with a time before which they do not meet.
// One body (near_needles_body.h) serves all instruction sets. With vectors of one float it is the
// scalar twin. They round differently, so that one may rule out a few pairs that another does not.
//
// The caller chooses a unit of length and a unit of time, both powers of two: the unit of length so
// that no needle is longer than one unit, the unit of time so that speeds are of order 1. All
// lengths and times below are in these units. Times count from a moment that the caller moves
// forward before they exceed `longest_time`.
#pragma once

#include <cstddef>
#include <cstdint>

#include "kernels/isa.h"
#include "kernels/needle_block.h"

namespace needlework::kernels {

inline constexpr float longest_time = 8;  ///< largest present time; the margins rely on it

/// Twice what the roundings of times in blocks and motions amount to. More is added to the ends of
/// searches, which may be far ahead. [unit of time]
inline constexpr double time_margin = 0x1p-18;

/// Covers the rounding of lengths to floats in cells of this side. [unit of length]
constexpr float margin_of_lengths(double side) {
  return static_cast<float>(0x1p-16 + side * 0x1p-19);
}

/// A needle's flight since `time`, centre relative to the corner of its cell: one cache line.
struct alignas(64) Motion {
  float r[3], v[3], u[3], p[3];  ///< p = w x u / |w|, or 0
  float omega;                   ///< |w|
  float time;                    ///< of r, u and p
  float until;                   ///< when the needle will search again
  float half;                    ///< half its length
};
static_assert(sizeof(Motion) == 64);

/// A cell to look into: its first block and its corner less that of the searching needle's cell.
struct CellView {
  std::uint32_t block;
  float offset[3];
};

/// The cells around a needle.
struct Surroundings {
  const NeedleBlock* blocks;
  const std::uint32_t* next;  ///< for each block: the next one of its cell, or none
  const CellView* cells;
  std::size_t cell_count;
  WordFormat format;                ///< of the words in the blocks
  const Motion* motions = nullptr;  ///< of all needles, if those of found ones are to be prefetched
  /// Of bodies that differ: how much longer half the length of each is than Seeker::longest_half,
  /// in the lanes of its block; null where that is the bound for all. [unit of length]
  const BlockReaches* reaches = nullptr;
};

/// Needles found in the cells, in columns with room for one block more than there are needles.
struct Found {
  std::uint32_t* needle;
  std::uint32_t* cell;  ///< index of the CellView
};

/// The needle that searches.
struct Seeker {
  Motion motion;     ///< at `now`
  float r[3], u[3];  ///< centre and director of its capsule, as in its block; or of its path
  float now;         ///< present time
  float ahead;       ///< how far it searches
  float margin;      ///< margin_of_lengths(); does not cover words
  /// Half the length of the longest needle, which each other one may have; for approaching(), the
  /// largest distance of axes in contact more. Where there are Surroundings::reaches, they come on
  /// top of it.
  float longest_half;
  std::uint32_t needle;  ///< itself; not reported, nor its images
  float axis_half = 0;   ///< half the length of the capsule's axis, or of the path
};

/// Pairs to be looked at more closely, in columns: the second needle as seen from the seeker.
/// Columns have room for one block more; bracket() overwrites that of `from`.
struct PairColumns {
  enum Column {
    r_x,
    r_y,
    r_z,  // seeker's centre less the other's, now
    v_x,
    v_y,
    v_z,  // seeker's velocity less the other's
    u_x,
    u_y,
    u_z,
    p_x,
    p_y,
    p_z,
    omega,     // the other's rotation
    half,      // half the other's length
    age,       // time since the other's u and p
    until,     // how far ahead this pair is searched
    from,      // in: the pair is searched from this time from now on; out: it does not meet between
               // that time and this one; infinite: it does not meet until `until`
    distance,  // of the axes of bodies with a width in contact; needles have none
    columns
  };
  float* column[columns];
};

/// The contact function of pairs, in columns with room for one block more than there are pairs. The
/// error bounds hold where the bounding spheres overlap and phases, |w| times the time since a
/// needle's u and p, are below 2^12 in sum; elsewhere bracket() does not use them.
struct ContactColumns {
  enum Column {
    f,
    df,
    ddf,
    dddf,     // its derivatives
    gap,      // how far the needles are apart, as segments
    error_f,  // by how much these may be off, of needles whose bounding spheres overlap
    error_df,
    error_ddf,
    error_dddf,
    columns
  };
  float* column[columns];
};

/// The counts of a scan of cells.
struct Scan {
  std::size_t seen;   ///< needles in the cells
  std::size_t found;  ///< of these, how many were found
};

/// The table of one instruction set.
struct NearKernels {
  Isa isa;
  std::size_t lanes;

  /// Needles whose bounding volumes, capsules of radius `radius` around where they have been
  /// placed, overlap the seeker's.
  Scan (*overlapping)(const Surroundings& around, const Seeker& seeker, float radius,
                      const Found& found);
  /// Needles whose bounding spheres overlap the seeker's at some time ahead. Between the time of
  /// its entry and its next placing no needle may move along an axis by more than the range of
  /// words.
  Scan (*approaching)(const Surroundings& around, const Seeker& seeker, const Found& found);
  /// Needles whose capsules' axes come nearer than `distance` to the seeker's segment, which is the
  /// axis of its capsule or the path of its centre.
  Scan (*near_capsules)(const Surroundings& around, const Seeker& seeker, float distance,
                        const Found& found);
  /// Needles whose centres come nearer than `distance` to the axis of the seeker's capsule in the
  /// time ahead. What is said of approaching() about how far they move is true here, too.
  Scan (*near_paths)(const Surroundings& around, const Seeker& seeker, float distance,
                     const Found& found);
  /// The contact function of the first n pairs at time s from now, as bracket() computes it.
  void (*contact_function)(const Seeker& seeker, const PairColumns& pairs, std::size_t n, float s,
                           const ContactColumns& out);
  /// Finds for each of the first n pairs a time before which it does not meet, and sets its column
  /// `from` to that. Returns how many vectors of contact functions it has evaluated.
  std::size_t (*bracket)(const Seeker& seeker, const PairColumns& pairs, std::size_t n);
  /// The same for rods, which meet where their axes are not farther apart than their `distance`.
  std::size_t (*bracket_rods)(const Seeker& seeker, const PairColumns& pairs, std::size_t n);
  /// The same for spheres, of which it reads the places, velocities, times and distances only. One
  /// vector of pairs takes one evaluation.
  std::size_t (*bracket_spheres)(const Seeker& seeker, const PairColumns& pairs, std::size_t n);
};

/// Kernels of an instruction set that is available().
const NearKernels& near_kernels(Isa isa);

}  // namespace needlework::kernels
