#include "bindings/take_gil.h"

#ifndef _WIN32
#include <pthread.h>
#include <unistd.h>

static void wait_for_the_end(void* unused) {
  (void)unused;
  while (1) pause();
}
#else
/* Windows ends a thread without unwinding it. */
#define pthread_cleanup_push(function, data)
#define pthread_cleanup_pop(run)
#endif

void riffler_restore_thread(PyThreadState* state) {
  pthread_cleanup_push(wait_for_the_end, NULL);
  PyEval_RestoreThread(state);
  pthread_cleanup_pop(0);
}

PyGILState_STATE riffler_ensure_gil(void) {
  PyGILState_STATE state;
  pthread_cleanup_push(wait_for_the_end, NULL);
  state = PyGILState_Ensure();
  pthread_cleanup_pop(0);
  return state;
}
