// By how much what is reported may differ from what the audit finds.
#pragma once

namespace needlework::audit {

/// Times may be off by this fraction of the flight, plus four times the pair's condition limit.
inline constexpr double relative_tolerance = 1e-12;
/// A collision before its contact is early. Without a contact within this fraction of the time in
/// which the pair changes, there is none.
inline constexpr double early_reach = 0x1p-10;
/// Needles that touch, to within rounding, for longer than this fraction of that time may have
/// passed through each other.
inline constexpr double longest_touch = 0x1p-10;
/// By what the motion of needles in contact may differ from that of the engine, of lengths, angles
/// and relative velocities: what its steps leave over.
inline constexpr double contact_noise = 0x1p-43;

}  // namespace needlework::audit
