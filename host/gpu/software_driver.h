#pragma once

namespace parhelion::gpu {

/// The widest vectors this CPU's instructions hold, as the software driver can use them: 512, 256 or 128 bits.
unsigned widestVectorBits();

/// Sets, through the environment, the vector width of Mesa's software driver and a shader cache folder of that
/// width's own: the driver's cache key lacks the width, so a shared folder would serve code of another width.
/// Variables that are set already stay as they are, so the first call of a process decides.
///
/// Call it before the instance is created. @param vectorBits 128, 256, 512, or 0 for the widest the CPU has, up to
/// preferredBits.
/// @throws InputError for another value, or when a width other than `vectorBits` is already decided.
void configureSoftwareDriver(unsigned vectorBits, unsigned preferredBits = 512);

}  // namespace parhelion::gpu
