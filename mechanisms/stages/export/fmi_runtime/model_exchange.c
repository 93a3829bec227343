/* Model exchange: the importer integrates coordinates, speeds and work.

   What its steps leave of the constraints is projected away at events, which the unit asks for when it grows. */
#include <string.h>

#include "instance.h"

EXPORT Status fmi3EnterEventMode(void *instance) {
    ((Instance *)instance)->kept.mode = EVENT;
    return OK;
}

EXPORT Status fmi3EnterContinuousTimeMode(void *instance) {
    ((Instance *)instance)->kept.mode = CONTINUOUS;
    return OK;
}

EXPORT Status fmi3UpdateDiscreteStates(void *instance, bool *again, bool *terminate, bool *nominals_changed,
                                       bool *states_changed, bool *next_defined, double *next) {
    Instance *it = instance;
    *again = *terminate = *nominals_changed = *states_changed = false;
    it->kept.behind = true;
    double moved;
    Status status = it->exchange ? project_state(it, 2, &moved) : OK;
    *states_changed = it->exchange;
    it->kept.changed = it->kept.jumped = false;
    int k = next_stop(it);
    *next_defined = k < STOPS;
    *next = k < STOPS ? STOP_BEFORE[k] : 0.0;
    return status;
}

EXPORT Status fmi3CompletedIntegratorStep(void *instance, bool no_way_back, bool *event, bool *terminate) {
    Instance *it = instance;
    (void)no_way_back;
    *event = *terminate = false;
    double kept[2 * N3], moved;
    memcpy(kept, numbers(it, AT_Y), sizeof kept);
    Status status = project_state(it, 1, &moved);
    memcpy(numbers(it, AT_Y), kept, sizeof kept);
    *event = status == OK && moved > DRIFT;
    return status;
}

EXPORT Status fmi3SetTime(void *instance, double time) {
    Instance *it = instance;
    if (time != it->kept.time) it->kept.behind = false;
    it->kept.time = time;
    numbers(it, AT_CLOCK)[TIME] = time;
    it->kept.rates_valid = it->kept.rows_valid = false;
    return OK;
}

static bool counts(Instance *it, size_t count, Status *status) {
    *status = count == STATES ? OK : say(it, ERROR, "there are %d states, not %zu", STATES, count);
    return count == STATES;
}

EXPORT Status fmi3SetContinuousStates(void *instance, const double states[], size_t count) {
    Instance *it = instance;
    Status status;
    if (!counts(it, count, &status)) return status;
    memcpy(numbers(it, AT_Y) + 3, states, (N3 - 3) * sizeof(double));
    memcpy(numbers(it, AT_Y) + N3 + 3, states + N3 - 3, (N3 - 3) * sizeof(double));
    numbers(it, AT_CLOCK)[WORK] = states[STATES - 1];
    it->kept.rates_valid = it->kept.rows_valid = false;
    return OK;
}

EXPORT Status fmi3GetContinuousStates(void *instance, double states[], size_t count) {
    Instance *it = instance;
    Status status;
    if (!counts(it, count, &status)) return status;
    memcpy(states, numbers(it, AT_Y) + 3, (N3 - 3) * sizeof(double));
    memcpy(states + N3 - 3, numbers(it, AT_Y) + N3 + 3, (N3 - 3) * sizeof(double));
    states[STATES - 1] = numbers(it, AT_CLOCK)[WORK];
    return OK;
}

EXPORT Status fmi3GetContinuousStateDerivatives(void *instance, double rates[], size_t count) {
    Instance *it = instance;
    Status status;
    if (!counts(it, count, &status)) return status;
    status = evaluate(it);
    memcpy(rates, numbers(it, AT_Y) + N3 + 3, (N3 - 3) * sizeof(double));
    memcpy(rates + N3 - 3, numbers(it, AT_DY) + N3 + 3, (N3 - 3) * sizeof(double));
    rates[STATES - 1] = numbers(it, AT_CLOCK)[POWER];
    return status;
}

EXPORT Status fmi3GetNominalsOfContinuousStates(void *instance, double nominals[], size_t count) {
    Status status;
    if (!counts(instance, count, &status)) return status;
    memcpy(nominals, NOMINAL, sizeof NOMINAL);
    return OK;
}

EXPORT Status fmi3GetNumberOfContinuousStates(void *instance, size_t *count) {
    (void)instance;
    *count = STATES;
    return OK;
}

EXPORT Status fmi3GetNumberOfEventIndicators(void *instance, size_t *count) {
    (void)instance;
    *count = 0;
    return OK;
}

EXPORT Status fmi3GetEventIndicators(void *instance, double indicators[], size_t count) {
    (void)instance, (void)indicators;
    return count == 0 ? OK : ERROR;
}
