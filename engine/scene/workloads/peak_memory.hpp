#pragma once

/// Peak memory of this process as Linux reports it (proc(5)).
namespace tumble {

/// Resets the peak to the present use, if the system supports that.
void restart_peak_memory();
/// Peak since the last reset [MB]; 0 if it is unknown.
double peak_memory();

}  // namespace tumble
