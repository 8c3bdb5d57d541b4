// Loads the plugin that its argument names and runs it; knows nothing of Sheaf.
#include <dlfcn.h>

#include <cstdio>

int main(int count, char** arguments) {
  if (count != 2) return 2;
  void* plugin = dlopen(arguments[1], RTLD_NOW | RTLD_LOCAL);
  void* run = plugin == nullptr ? nullptr : dlsym(plugin, "RunPlugin");
  if (run == nullptr) return std::fprintf(stderr, "%s\n", dlerror()), 1;
  return reinterpret_cast<int (*)()>(run)();
}
