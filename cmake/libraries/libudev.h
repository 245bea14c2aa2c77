/* What hidapi calls of libudev, which udev.c loads at run time. Source: libudev(3). */
#ifndef RIFFLER_LIBUDEV_H
#define RIFFLER_LIBUDEV_H

#include <stdarg.h> /* hidapi relies on it */
#include <sys/types.h>

struct udev;
struct udev_device;
struct udev_enumerate;
struct udev_list_entry;

struct udev* udev_new(void);
struct udev* udev_unref(struct udev* udev);

struct udev_device* udev_device_new_from_devnum(struct udev* udev, char type, dev_t number);
struct udev_device* udev_device_new_from_syspath(struct udev* udev, const char* path);
struct udev_device* udev_device_unref(struct udev_device* device);
struct udev_device* udev_device_get_parent_with_subsystem_devtype(struct udev_device* device, const char* subsystem,
                                                                  const char* type);
const char* udev_device_get_devnode(struct udev_device* device);
const char* udev_device_get_syspath(struct udev_device* device);
const char* udev_device_get_sysattr_value(struct udev_device* device, const char* name);

struct udev_enumerate* udev_enumerate_new(struct udev* udev);
struct udev_enumerate* udev_enumerate_unref(struct udev_enumerate* enumerate);
int udev_enumerate_add_match_subsystem(struct udev_enumerate* enumerate, const char* subsystem);
int udev_enumerate_scan_devices(struct udev_enumerate* enumerate);
struct udev_list_entry* udev_enumerate_get_list_entry(struct udev_enumerate* enumerate);

struct udev_list_entry* udev_list_entry_get_next(struct udev_list_entry* entry);
const char* udev_list_entry_get_name(struct udev_list_entry* entry);
#define udev_list_entry_foreach(entry, first) \
  for ((entry) = (first); (entry) != NULL; (entry) = udev_list_entry_get_next(entry))

#endif
