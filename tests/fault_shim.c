/* Loaded before the C library: makes the n-th allocation, or the n-th call about files, fail.
 *   SHEAF_FAULT=memory|file|short   what fails; short: writes write one byte
 *   SHEAF_FAULT_AT=N                which, from 1; absent: none
 *   SHEAF_FAULT_LASTING=1           and all after it
 *   SHEAF_FAULT_CODE=ERRNO          of files; EIO if absent
 *   SHEAF_FAULT_KILLS=1             kills the process in the place of the call
 *   SHEAF_FAULT_COUNT=FILE          written at the end: how many there were */
#define _GNU_SOURCE
#include <dlfcn.h>
#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/types.h>
#include <unistd.h>

/* The allocator of glibc under its own names: dlsym would allocate. */
extern void* __libc_malloc(size_t);
extern void* __libc_calloc(size_t, size_t);
extern void* __libc_realloc(void*, size_t);
extern void* __libc_memalign(size_t, size_t);

enum Kind { kUnknown, kNone, kMemory, kFile, kShort };
static enum Kind kind = kUnknown;
static long at, lasting, kills, count;
static int code;

static void Read(void) {
  const char* name = getenv("SHEAF_FAULT");
  const char* text = getenv("SHEAF_FAULT_AT");
  at = text ? atol(text) : 0;
  lasting = getenv("SHEAF_FAULT_LASTING") != NULL;
  kills = getenv("SHEAF_FAULT_KILLS") != NULL;
  text = getenv("SHEAF_FAULT_CODE");
  code = text ? atoi(text) : EIO;
  kind = !name                         ? kNone
         : strcmp(name, "memory") == 0 ? kMemory
         : strcmp(name, "short") == 0  ? kShort
                                       : kFile;
}

static int Fails(enum Kind of) {
  if (kind == kUnknown) Read();
  if (kind != of) return 0;
  const long now = __atomic_add_fetch(&count, 1, __ATOMIC_RELAXED);
  const int fails = at > 0 && (now == at || (lasting && now > at));
  if (fails && kills) raise(SIGKILL);
  return fails;
}

__attribute__((destructor)) static void Report(void) {
  const char* path = getenv("SHEAF_FAULT_COUNT");
  if (!path) return;
  const enum Kind was = kind;
  kind = kNone;
  FILE* file = fopen(path, "w");
  if (file) {
    fprintf(file, "%ld\n", count);
    fclose(file);
  }
  kind = was;
}

/* ---- Memory ---- */

static void* None(void) {
  errno = ENOMEM;
  return NULL;
}

void* malloc(size_t size) { return Fails(kMemory) ? None() : __libc_malloc(size); }
void* calloc(size_t n, size_t size) { return Fails(kMemory) ? None() : __libc_calloc(n, size); }
void* realloc(void* p, size_t size) { return Fails(kMemory) ? None() : __libc_realloc(p, size); }
void* memalign(size_t to, size_t size) {
  return Fails(kMemory) ? None() : __libc_memalign(to, size);
}
void* aligned_alloc(size_t to, size_t size) { return memalign(to, size); }
int posix_memalign(void** p, size_t to, size_t size) {
  *p = memalign(to, size);
  return *p ? 0 : ENOMEM;
}

/* ---- Files ---- */

#define REAL(name) ((__typeof__(&name))dlsym(RTLD_NEXT, #name))
#define FAIL(value)   \
  if (Fails(kFile)) { \
    errno = code;     \
    return value;     \
  }

ssize_t write(int descriptor, const void* bytes, size_t size) {
  if (descriptor > 2) {
    FAIL(-1)
    if (size > 1 && Fails(kShort)) size = 1;
  }
  return REAL(write)(descriptor, bytes, size);
}
ssize_t pwrite(int descriptor, const void* bytes, size_t size, off_t offset) {
  FAIL(-1)
  if (size > 1 && Fails(kShort)) size = 1;
  return REAL(pwrite)(descriptor, bytes, size, offset);
}
ssize_t pwrite64(int descriptor, const void* bytes, size_t size, off64_t offset) {
  return pwrite(descriptor, bytes, size, offset);
}
int fsync(int descriptor) {
  FAIL(-1)
  return REAL(fsync)(descriptor);
}
int fdatasync(int descriptor) {
  FAIL(-1)
  return REAL(fdatasync)(descriptor);
}
int fchmod(int descriptor, mode_t mode) {
  FAIL(-1)
  return REAL(fchmod)(descriptor, mode);
}
int rename(const char* from, const char* to) {
  FAIL(-1)
  return REAL(rename)(from, to);
}
int linkat(int from_folder, const char* from, int to_folder, const char* to, int flags) {
  FAIL(-1)
  return REAL(linkat)(from_folder, from, to_folder, to, flags);
}
int access(const char* path, int mode) {
  FAIL(-1)
  return REAL(access)(path, mode);
}
int close(int descriptor) {
  const int fails = Fails(kFile);
  const int closed = REAL(close)(descriptor);
  if (!fails) return closed;
  errno = code;
  return -1;
}
static mode_t ModeOf(int flags, va_list rest) {
  return flags & (O_CREAT | O_TMPFILE) ? va_arg(rest, mode_t) : 0;
}
#define OPEN(name)                             \
  int name(const char* path, int flags, ...) { \
    va_list rest;                              \
    va_start(rest, flags);                     \
    const mode_t mode = ModeOf(flags, rest);   \
    va_end(rest);                              \
    FAIL(-1)                                   \
    return REAL(name)(path, flags, mode);      \
  }
OPEN(open)
OPEN(open64)
FILE* fopen(const char* path, const char* mode) {
  FAIL(NULL)
  return REAL(fopen)(path, mode);
}
FILE* fopen64(const char* path, const char* mode) {
  FAIL(NULL)
  return REAL(fopen64)(path, mode);
}
