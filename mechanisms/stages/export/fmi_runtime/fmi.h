/* Types of the FMI 3.0 interface, section 2.1 of the standard (fmi-standard.org/docs/3.0). */
#ifndef FMI_H
#define FMI_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#if defined _WIN32
#define EXPORT __declspec(dllexport)
#else
#define EXPORT __attribute__((visibility("default")))
#endif

typedef enum { OK, WARNING, DISCARD, ERROR, FATAL } Status;
typedef uint32_t Reference;
typedef const char *Text;
typedef void (*Log)(void *environment, Status status, Text category, Text message);
typedef void (*IntermediateUpdate)(void *environment, double time, bool set_requested, bool get_allowed, bool finished,
                                   bool can_return, bool *return_requested, double *return_time);

#endif
