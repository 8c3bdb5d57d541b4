// How fast the machine is right now.
#ifndef SHEAF_LAB_CALIBRATE_H_
#define SHEAF_LAB_CALIBRATE_H_

namespace sheaf {

// The seconds that a fixed piece of work takes, about 10 ms on `threads` threads, from 1. It shares
// no code with the renderer, so that a change there leaves it alone, and what slows the whole
// machine slows it too: times that are divided by it can be compared from run to run.
double CalibrationSeconds(int threads);

}  // namespace sheaf

#endif  // SHEAF_LAB_CALIBRATE_H_
