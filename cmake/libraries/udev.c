/* Loads the system's libudev when hidapi first needs it. A wheel must not contain one, since libudev reads the files of
 * the udev that runs, and a program without a pen must start where there is none: udev_new then returns NULL, which
 * hidapi reports as a failed search for devices. */
#include "libudev.h"

#include <dlfcn.h>
#include <pthread.h>
#include <stddef.h>

/* X(result, name, parameters, arguments): every function but udev_new, which loads them. */
#define FUNCTIONS(X)                                                                                 \
  X(struct udev*, udev_unref, (struct udev * u), (u))                                                \
  X(struct udev_device*, udev_device_new_from_devnum, (struct udev * u, char t, dev_t n), (u, t, n)) \
  X(struct udev_device*, udev_device_new_from_syspath, (struct udev * u, const char* p), (u, p))     \
  X(struct udev_device*, udev_device_unref, (struct udev_device * d), (d))                           \
  X(struct udev_device*, udev_device_get_parent_with_subsystem_devtype,                              \
    (struct udev_device * d, const char* s, const char* t), (d, s, t))                               \
  X(const char*, udev_device_get_devnode, (struct udev_device * d), (d))                             \
  X(const char*, udev_device_get_syspath, (struct udev_device * d), (d))                             \
  X(const char*, udev_device_get_sysattr_value, (struct udev_device * d, const char* n), (d, n))     \
  X(struct udev_enumerate*, udev_enumerate_new, (struct udev * u), (u))                              \
  X(struct udev_enumerate*, udev_enumerate_unref, (struct udev_enumerate * e), (e))                  \
  X(int, udev_enumerate_add_match_subsystem, (struct udev_enumerate * e, const char* s), (e, s))     \
  X(int, udev_enumerate_scan_devices, (struct udev_enumerate * e), (e))                              \
  X(struct udev_list_entry*, udev_enumerate_get_list_entry, (struct udev_enumerate * e), (e))        \
  X(struct udev_list_entry*, udev_list_entry_get_next, (struct udev_list_entry * e), (e))            \
  X(const char*, udev_list_entry_get_name, (struct udev_list_entry * e), (e))

static pthread_once_t once = PTHREAD_ONCE_INIT;
static struct udev* (*udev_new_loaded)(void);
#define DEFINE(result, name, parameters, arguments) \
  static result(*name##_loaded) parameters;         \
  result name parameters {                          \
    return name##_loaded arguments;                 \
  }
FUNCTIONS(DEFINE)

static void load(void) {
  void* const library = dlopen("libudev.so.1", RTLD_NOW | RTLD_LOCAL);
  if (library == NULL) return;
  int complete = 1;
#define LOAD(result, name, parameters, arguments)  \
  *(void**)&name##_loaded = dlsym(library, #name); \
  complete = complete && name##_loaded != NULL;
  FUNCTIONS(LOAD)
  if (complete) *(void**)&udev_new_loaded = dlsym(library, "udev_new");
}

struct udev* udev_new(void) {
  pthread_once(&once, load);
  return udev_new_loaded != NULL ? udev_new_loaded() : NULL;
}
