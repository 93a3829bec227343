/* An instance from its making to its end, and copies of its state. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "instance.h"

EXPORT const char *fmi3GetVersion(void) { return "3.0"; }

static Instance *made(Text name, Text token, bool logging, void *environment, Log log, bool exchange) {
    if (token == NULL || strcmp(token, TOKEN) != 0) {
        if (log) log(environment, ERROR, "logStatusError", MODEL_NAME ": the instantiation token is not that of this unit");
        return NULL;
    }
    Instance *it = calloc(1, sizeof *it);
    if (it == NULL) return NULL;
    snprintf(it->name, sizeof it->name, "%s", name ? name : "");
    it->logging = logging, it->environment = environment, it->log = log, it->exchange = exchange;
    it->kept.mode = INSTANTIATED;
    fill(it);
    return it;
}

EXPORT void *fmi3InstantiateModelExchange(Text name, Text token, Text resources, bool visible, bool logging,
                                          void *environment, Log log) {
    (void)resources, (void)visible;
    return made(name, token, logging, environment, log, true);
}

EXPORT void *fmi3InstantiateCoSimulation(Text name, Text token, Text resources, bool visible, bool logging,
                                         bool event_mode, bool early_return, const Reference intermediate[],
                                         size_t count, void *environment, Log log, IntermediateUpdate update) {
    (void)resources, (void)visible, (void)event_mode, (void)intermediate, (void)count, (void)update;
    Instance *it = made(name, token, logging, environment, log, false);
    if (it) it->early = early_return;
    return it;
}

EXPORT void fmi3FreeInstance(void *instance) { free(instance); }

EXPORT Status fmi3SetDebugLogging(void *instance, bool on, size_t count, const Text categories[]) {
    (void)count, (void)categories;
    ((Instance *)instance)->logging = on;
    return OK;
}

static void set_tolerance(Instance *it, double tolerance) {
    double factor = tolerance / TOLERANCE;
    for (int c = 0; c < 2 * N3; c++) {
        numbers(it, AT_ABSOLUTE)[c] *= factor;
        numbers(it, AT_GROWING)[c] *= factor;
    }
    memcpy(&it->advance[ADVANCE_RELATIVE], &tolerance, sizeof tolerance);
}

EXPORT Status fmi3EnterInitializationMode(void *instance, bool with_tolerance, double tolerance, double start,
                                          bool with_stop, double stop) {
    Instance *it = instance;
    if (fabs(start - START_TIME) > 1e-12 * (1.0 + fabs(START_TIME)))
        return say(it, ERROR, "it starts at t = %.9g s, not at %.9g s", START_TIME, start);
    if (with_stop && !(stop > start)) return say(it, ERROR, "the stop time %.9g s is not after the start", stop);
    if (with_tolerance && !(tolerance > 0.0 && tolerance < 1.0))
        return say(it, ERROR, "the tolerance %g is not between 0 and 1", tolerance);
    if (with_tolerance) set_tolerance(it, tolerance);
    it->kept.mode = INITIALIZATION;
    return OK;
}

EXPORT Status fmi3ExitInitializationMode(void *instance) {
    Instance *it = instance;
    double moved;
    if (it->kept.changed) {
        Status status = project_state(it, 4, &moved);
        if (status != OK) return status;
        if (moved > FAR)
            return say(it, ERROR, "the start that is given moves by %.2g of the size to fulfil the constraints", moved);
    }
    it->kept.changed = it->kept.jumped = false;
    it->kept.mode = it->exchange ? EVENT : STEPPING;
    return OK;
}

EXPORT Status fmi3Terminate(void *instance) {
    ((Instance *)instance)->kept.mode = TERMINATED;
    return OK;
}

EXPORT Status fmi3Reset(void *instance) {
    Instance *it = instance;
    fill(it);
    it->kept.mode = INSTANTIATED;
    return OK;
}

typedef struct {
    char token[sizeof TOKEN];
    bool exchange;
    Kept kept;
} State; /* a copy of what an instance is at one time, and which unit's it is: its lengths and masses are in it */

static Status refuse_other_state(Instance *it, const State *state) {
    if (memcmp(state->token, TOKEN, sizeof TOKEN) != 0)
        return say(it, ERROR, "the state is of another unit than " MODEL_NAME " " TOKEN "; take one that this unit gave");
    if (state->exchange != it->exchange)
        return say(it, ERROR, "the state is of an instance for %s, this one is for %s",
                   state->exchange ? "model exchange" : "co-simulation", it->exchange ? "model exchange" : "co-simulation");
    return OK;
}

static Status refuse_other_size(Instance *it, size_t size) {
    return size == sizeof(State) ? OK : say(it, ERROR, "a state has %zu bytes, not %zu", sizeof(State), size);
}

EXPORT Status fmi3GetFMUState(void *instance, void **state) {
    Instance *it = instance;
    if (*state == NULL) *state = calloc(1, sizeof(State));
    if (*state == NULL) return say(it, ERROR, "there is no memory for a state");
    State *copy = *state;
    memcpy(copy->token, TOKEN, sizeof TOKEN);
    copy->exchange = it->exchange;
    memcpy(&copy->kept, &it->kept, sizeof(Kept));
    return OK;
}

EXPORT Status fmi3SetFMUState(void *instance, void *state) {
    Instance *it = instance;
    const State *copy = state;
    Status status = refuse_other_state(it, copy);
    if (status != OK) return status;
    memcpy(&it->kept, &copy->kept, sizeof(Kept));
    relocate(it->kept.memory); /* it may come from another process */
    return OK;
}

EXPORT Status fmi3FreeFMUState(void *instance, void **state) {
    (void)instance;
    free(*state);
    *state = NULL;
    return OK;
}

EXPORT Status fmi3SerializedFMUStateSize(void *instance, void *state, size_t *size) {
    (void)instance, (void)state;
    *size = sizeof(State);
    return OK;
}

EXPORT Status fmi3SerializeFMUState(void *instance, void *state, uint8_t bytes[], size_t size) {
    Status status = refuse_other_size(instance, size);
    if (status == OK) memcpy(bytes, state, size);
    return status;
}

EXPORT Status fmi3DeserializeFMUState(void *instance, const uint8_t bytes[], size_t size, void **state) {
    Status status = refuse_other_size(instance, size);
    if (status != OK) return status;
    State *copy = calloc(1, sizeof(State));
    if (copy == NULL) return say(instance, ERROR, "there is no memory for a state");
    memcpy(copy, bytes, size);
    status = refuse_other_state(instance, copy);
    if (status != OK) {
        free(copy);
        return status;
    }
    free(*state);
    *state = copy;
    return OK;
}
