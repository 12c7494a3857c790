// Kernels by lanes that find, among many needles, those that one needle may meet soon.
//
// They work in float on compact copies of the records and only ever rule pairs out: with margins
// that cover every rounding, so that no choice of kernel or instruction set can change a
// trajectory. What they let pass goes to first_contact, with a time before which it meets nothing.
// One body (near_needles_body.h) serves all instruction sets; with one lane it is the plain twin,
// and the results are equal bit for bit.
//
// Lengths are in L. Velocities are scaled by a power of two, the caller's unit of time, so that
// they are of order 1; times are in that unit and count from a moment that the caller sets anew
// before they exceed `longest_time`.
#pragma once

#include <cstddef>
#include <cstdint>

#include "kernels/isa.h"

namespace needlework::kernels {

inline constexpr std::size_t block_size = 16;  ///< needles in a block: one vector of AVX-512
inline constexpr float longest_time = 8;       ///< of the times below, see their rounding

/// Up to 16 needles of one cell, in columns: where they have been placed, relative to the corner of
/// the cell. Cells with more needles chain blocks.
struct alignas(64) NeedleBlock {
  enum Column { x, y, z, a_x, a_y, a_z, time, columns };

  float column[columns][block_size];  ///< centre; director or velocity; time of the centre
  std::uint32_t needle[block_size];
};

/// What belongs to a block and is better kept apart, for many cells are empty.
struct BlockLink {
  static constexpr std::uint32_t none = 0xffffffff;

  std::uint32_t size = 0;     ///< needles in the block, in its first places
  std::uint32_t next = none;  ///< the next block of the same cell
};

/// A needle's flight since `time`, centre relative to the corner of its cell: one cache line.
struct alignas(64) Motion {
  float r[3], v[3], u[3], p[3];  ///< p = w x u / |w|, or 0
  float omega;                   ///< |w|
  float time;                    ///< of r, u and p
  float until;                   ///< when the needle will be placed anew
};

/// A cell to look into: its first block and its corner less that of the searching needle's cell.
struct CellView {
  std::uint32_t block;
  float offset[3];
};

/// The cells around a needle.
struct Surroundings {
  const NeedleBlock* blocks;
  const BlockLink* links;  ///< one for each block
  const CellView* cells;
  std::size_t cell_count;
  const Motion* motions = nullptr;  ///< of all needles; those of found ones are brought near
};

/// Needles found in the cells, in columns with room for one block more than there are needles.
struct Found {
  std::uint32_t* needle;
  std::uint32_t* cell;  ///< index of the CellView
};

/// The needle that searches.
struct Seeker {
  Motion motion;         ///< at `now`
  float r[3], u[3];      ///< centre and director of its hull, as in its block
  float now;             ///< present time
  float ahead;           ///< how far it searches
  float margin;          ///< of lengths; covers what rounding did to the columns [L]
  std::uint32_t needle;  ///< itself; not reported, nor its images
};

/// Pairs to be looked at more closely, in columns: the second needle as seen from the seeker.
/// Columns have room for two blocks more, which bracket() overwrites.
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
    omega,  // the other's rotation
    age,    // time since the other's u and p
    until,  // how far ahead this pair is searched
    from,   // looked at from this time from now on; result: it meets nothing between that and
            // this time; infinite: nor later
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

/// What a scan of cells came to.
struct Scan {
  std::size_t seen;   ///< needles in the cells
  std::size_t found;  ///< of these, how many were found
};

/// The table of one instruction set.
struct NearKernels {
  Isa isa;
  std::size_t lanes;

  /// Needles whose hulls, capsules of radius `radius` around where they have been placed, overlap
  /// the seeker's.
  Scan (*overlapping)(const Surroundings& around, const Seeker& seeker, float radius,
                      const Found& found);
  /// Needles whose bounding spheres come to overlap the seeker's in the time ahead; their columns
  /// a are velocities.
  Scan (*approaching)(const Surroundings& around, const Seeker& seeker, const Found& found);
  /// What bracket() knows of the first n pairs at time s from now.
  void (*contact_function)(const Seeker& seeker, const PairColumns& pairs, std::size_t n, float s,
                           const ContactColumns& out);
  /// Sets `from` of the first n pairs. Returns the evaluations of the contact function, by lanes.
  std::size_t (*bracket)(const Seeker& seeker, const PairColumns& pairs, std::size_t n);
};

/// Kernels of an instruction set that is available().
const NearKernels& near_kernels(Isa isa);

}  // namespace needlework::kernels
