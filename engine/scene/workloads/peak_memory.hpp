#pragma once

/// The most memory that this process has held, as Linux tells it (proc(5)).
namespace tumble {

/// Counts anew from what is held now, where the system can.
void restart_peak_memory();
/// Since the last restart [MB]; 0 where it cannot be known.
double peak_memory();

}  // namespace tumble
