// How many threads the process may use.
#ifndef SHEAF_APP_ALLOW_THREADS_H_
#define SHEAF_APP_ALLOW_THREADS_H_

namespace sheaf {

// More threads than cores: a user who asks for them gets them, since nobody else is in this
// process. Until its end; where cores suffice oneTBB's limit is left alone.
void AllowThreads(int threads);

}  // namespace sheaf

#endif  // SHEAF_APP_ALLOW_THREADS_H_
