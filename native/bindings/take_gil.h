/* Takes Python's lock. While Python ends, versions before 3.14 end a daemon thread here by pthread_exit, which unwinds
 * it. These functions then wait for the end of the process: C's cleanup handlers run before the unwinding gets to a
 * frame of C++, whose run-time library may be another one than the unwinding's (libc++ in a process with libgcc). */
#pragma once

#include <Python.h>

#ifdef __cplusplus
extern "C" {
#endif

void riffler_restore_thread(PyThreadState* state);
PyGILState_STATE riffler_ensure_gil(void);

#ifdef __cplusplus
}
#endif
