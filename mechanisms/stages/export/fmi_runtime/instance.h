/* An instance: the mechanism's memory, and what the kernels are called with. */
#ifndef INSTANCE_H
#define INSTANCE_H

#include "fmi.h"

typedef struct {
    int64_t value;
    int place; /* whether the value is a place in the memory */
} Word;

typedef struct {
    int kind, index, component;
    int64_t place;
    double start;
} Variable;

typedef struct {
    int body;
    double x, y, angle; /* from the centre of mass, in the body's axes */
} Frame;

typedef struct {
    int body;        /* on which the joint acts: the second, or the first where the second is ground */
    int second;      /* whether that is the second body of its rows */
    int carrier;     /* of its second marker */
    double x, y;     /* of the marker, from the carrier's centre of mass */
    int first, last; /* its rows */
} Joint;

typedef int32_t Kernel(void *result, void **error, int64_t *table);

#include "model.h"

enum { INSTANTIATED, INITIALIZATION, EVENT, CONTINUOUS, STEPPING, TERMINATED };

typedef struct {
    double time;
    bool rates_valid, rows_valid; /* whether rates and rows of J are those of the present state */
    bool changed;                 /* inputs or parameters since the last step */
    bool jumped;                  /* a rate: speeds must be projected */
    bool behind;                  /* the stop at the present time was passed */
    int mode;
    _Alignas(16) unsigned char memory[MEMORY_SIZE];
} Kept; /* all that a state of the unit is; what else is in an instance does not change with time */

typedef struct {
    Kept kept;
    bool exchange, early, logging;
    void *environment;
    Log log;
    int64_t advance[ADVANCE_WORDS], derivative[DERIVATIVE_WORDS], project[PROJECT_WORDS], jacobian[JACOBIAN_WORDS];
    char name[200];
} Instance;

static inline double *numbers(Instance *it, int64_t place) { return (double *)(it->kept.memory + place); }
static inline int64_t *integers(Instance *it, int64_t place) { return (int64_t *)(it->kept.memory + place); }

Status say(Instance *it, Status status, const char *words, ...);
void fill(Instance *it);                    /* memory and tables as at the start */
double time_of_laws(Instance *it);          /* behind a jump that was passed */
Status evaluate(Instance *it);              /* rates and multipliers at the present state */
Status rows(Instance *it);                  /* of J, after evaluate */
Status project_state(Instance *it, int passes, double *largest);
void frame(Instance *it, int index, double out[9]);
void reaction(Instance *it, int joint, double out[3]);
double energy(Instance *it, int which);
void set_mass(Instance *it, int body, double mass);
void set_inertia(Instance *it, int body, double inertia);
void set_gravity(Instance *it, int component, double value);
void set_rate(Instance *it, int driver, int64_t place, double rate);
int next_stop(Instance *it);                /* index of the first stop after the present time, STOPS if there is none */

#endif
