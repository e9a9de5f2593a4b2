// SPDX-License-Identifier: MIT
// A library to preload: the N-th call of one kind, counted from the beginning of main, fails as on a full disk or without
// memory. DELF_FAIL=alloc:N, write:N, fsync:N or rename:N; with a + behind N all later ones fail too. With DELF_FAIL=alloc:0
// nothing fails; DELF_FAIL_COUNT names a file that gets the number of calls.
#include <dlfcn.h>
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <atomic>

namespace {

char kind[8];
long wanted;
bool later;
std::atomic<long> seen;
std::atomic<bool> armed;

bool fails(const char* which) {
  if (!armed || strcmp(which, kind) != 0) return false;
  const long n = ++seen;
  return wanted > 0 && (n == wanted || (later && n > wanted));
}

void* none() {
  errno = ENOMEM;
  return nullptr;
}

// Not what is said to people: a report that is lost is another test.
bool refused(int file) {
  if (file <= 2 || !fails("write")) return false;
  errno = ENOSPC;
  return true;
}

// The function of that name that this library hides.
template <class Function>
Function* hidden(const char* name) {
  return reinterpret_cast<Function*>(dlsym(RTLD_NEXT, name));
}

int (*real_main)(int, char**, char**);

void report() {
  const char* file = getenv("DELF_FAIL_COUNT");
  armed = false;
  FILE* out = file ? fopen(file, "w") : nullptr;
  if (!out) return;
  fprintf(out, "%ld\n", seen.load());
  fclose(out);
}

int armed_main(int count, char** words, char** environment) {
  const char* fail = getenv("DELF_FAIL");
  if (fail && sscanf(fail, "%7[a-z]:%ld", kind, &wanted) == 2) later = fail[strlen(fail) - 1] == '+';
  unsetenv("LD_PRELOAD");  // not in the programs that it starts
  atexit(report);
  armed = true;
  return real_main(count, words, environment);
}

}  // namespace

extern "C" {

void* __libc_malloc(size_t);
void* __libc_calloc(size_t, size_t);
void* __libc_realloc(void*, size_t);
void* __libc_memalign(size_t, size_t);

void* malloc(size_t size) noexcept { return fails("alloc") ? none() : __libc_malloc(size); }
void* calloc(size_t n, size_t size) noexcept { return fails("alloc") ? none() : __libc_calloc(n, size); }
void* realloc(void* old, size_t size) noexcept { return fails("alloc") ? none() : __libc_realloc(old, size); }
void* memalign(size_t a, size_t size) noexcept { return fails("alloc") ? none() : __libc_memalign(a, size); }
void* aligned_alloc(size_t a, size_t size) noexcept { return memalign(a, size); }
int posix_memalign(void** to, size_t a, size_t size) noexcept {
  void* made = memalign(a, size);
  if (!made) return ENOMEM;
  *to = made;
  return 0;
}

ssize_t write(int file, const void* bytes, size_t count) {
  return refused(file) ? -1 : hidden<decltype(write)>("write")(file, bytes, count);
}
ssize_t pwrite(int file, const void* bytes, size_t count, off_t at) {
  return refused(file) ? -1 : hidden<decltype(pwrite)>("pwrite")(file, bytes, count, at);
}
ssize_t pwrite64(int file, const void* bytes, size_t count, off64_t at) {
  return refused(file) ? -1 : hidden<decltype(pwrite64)>("pwrite64")(file, bytes, count, at);
}
int fsync(int file) {
  if (!fails("fsync")) return hidden<decltype(fsync)>("fsync")(file);
  errno = EIO;
  return -1;
}
int rename(const char* from, const char* to) noexcept {
  if (!fails("rename")) return hidden<decltype(rename)>("rename")(from, to);
  errno = EACCES;
  return -1;
}

int __libc_start_main(int (*main)(int, char**, char**), int count, char** words, void (*init)(), void (*fini)(),
                      void (*loader)(), void* stack) {
  real_main = main;
  return hidden<decltype(__libc_start_main)>("__libc_start_main")(armed_main, count, words, init, fini, loader, stack);
}

}  // extern "C"
