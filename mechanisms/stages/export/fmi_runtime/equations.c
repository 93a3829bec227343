/* What the kernels give, and what follows from it: frames, reactions, energy. */
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include "instance.h"

extern Kernel *const mbsd_derivative, *const mbsd_project, *const mbsd_jacobian;

Status say(Instance *it, Status status, const char *words, ...) {
    char message[600];
    int length = snprintf(message, sizeof message, "%s: ", MODEL_NAME);
    va_list rest;
    va_start(rest, words);
    vsnprintf(message + length, sizeof message - (size_t)length, words, rest);
    va_end(rest);
    if (it->log) it->log(it->environment, status, status >= ERROR ? "logStatusError" : "logStatusWarning", message);
    return status;
}

static void fill_table(Instance *it, const Word *words, int count, int64_t *table) {
    for (int k = 0; k < count; k++)
        table[k] = words[k].place ? (int64_t)(intptr_t)(it->kept.memory + words[k].value) : words[k].value;
}

void fill(Instance *it) {
    memcpy(it->kept.memory, MEMORY, MEMORY_SIZE);
    fill_table(it, ADVANCE_TABLE, ADVANCE_WORDS, it->advance);
    fill_table(it, DERIVATIVE_TABLE, DERIVATIVE_WORDS, it->derivative);
    fill_table(it, PROJECT_TABLE, PROJECT_WORDS, it->project);
    fill_table(it, JACOBIAN_TABLE, JACOBIAN_WORDS, it->jacobian);
    relocate(it->kept.memory);
    it->kept.time = START_TIME;
    it->kept.rates_valid = it->kept.rows_valid = it->kept.changed = it->kept.jumped = it->kept.behind = false;
}

static void put(int64_t *word, double value) { memcpy(word, &value, sizeof value); }

int next_stop(Instance *it) {
    int k = 0;
    while (k < STOPS && STOP_BEFORE[k] <= it->kept.time) k++;
    return k;
}

double time_of_laws(Instance *it) {
    int k = next_stop(it) - 1;
    bool at = k >= 0 && it->kept.behind && it->kept.time == STOP_BEFORE[k];
    return at ? STOP_AFTER[k] : it->kept.time;
}

Status evaluate(Instance *it) {
    if (it->kept.rates_valid) return OK;
    double power = 0.0;
    void *error = NULL;
    double *rates = numbers(it, AT_DY);
    put(&it->derivative[DERIVATIVE_TIME], time_of_laws(it));
    int32_t status = mbsd_derivative(&power, &error, it->derivative);
    numbers(it, AT_CLOCK)[POWER] = power;
    for (int c = 3; c < 2 * N3; c++)
        if (status != 0 || !isfinite(rates[c]))
            return say(it, DISCARD, "t = %.9g s: accelerations are not finite", it->kept.time);
    it->kept.rates_valid = true;
    it->kept.rows_valid = false;
    return OK;
}

Status rows(Instance *it) {
    Status status = evaluate(it);
    if (status != OK || it->kept.rows_valid) return status;
    int64_t result = 0;
    void *error = NULL;
    if (mbsd_jacobian(&result, &error, it->jacobian) != 0)
        return say(it, ERROR, "t = %.9g s: rows of constraints cannot be evaluated", it->kept.time);
    it->kept.rows_valid = true;
    return OK;
}

Status project_state(Instance *it, int passes, double *largest) {
    int64_t result = 0;
    void *error = NULL;
    put(&it->project[PROJECT_TIME], time_of_laws(it));
    it->project[PROJECT_PASSES] = passes;
    int32_t status = mbsd_project(&result, &error, it->project);
    *largest = numbers(it, AT_REPORT)[1];
    it->kept.rates_valid = it->kept.rows_valid = false;
    if (status != 0 || !isfinite(*largest))
        return say(it, ERROR, "t = %.9g s: coordinates do not fulfil the constraints", it->kept.time);
    return OK;
}

void frame(Instance *it, int index, double out[9]) {
    const Frame *own = &FRAME_OF[index];
    const double *q = numbers(it, AT_Y) + 3 * own->body, *v = q + N3, *a = numbers(it, AT_DY) + N3 + 3 * own->body;
    double c = cos(q[2]), s = sin(q[2]);
    double x = c * own->x - s * own->y, y = s * own->x + c * own->y;
    out[0] = q[0] + x;
    out[1] = q[1] + y;
    out[2] = q[2] + own->angle;
    out[3] = v[0] - v[2] * y;
    out[4] = v[1] + v[2] * x;
    out[5] = v[2];
    out[6] = a[0] - a[2] * y - v[2] * v[2] * x;
    out[7] = a[1] + a[2] * x - v[2] * v[2] * y;
    out[8] = a[2];
}

/* -J_b^T lam, moved from the centre of mass of body b to the second marker */
void reaction(Instance *it, int index, double out[3]) {
    const Joint *own = &JOINT_OF[index];
    const double *lam = numbers(it, AT_LAM), *jac = numbers(it, AT_JACOBIAN), *q = numbers(it, AT_Y);
    out[0] = out[1] = out[2] = 0.0;
    for (int r = own->first; r < own->last; r++)
        for (int c = 0; c < 3; c++) out[c] += jac[6 * r + (own->second ? 3 : 0) + c] * lam[r];
    for (int c = 0; c < 3; c++) out[c] *= own->second ? -1.0 : 1.0;
    const double *carrier = q + 3 * own->carrier, *body = q + 3 * own->body;
    double c = cos(carrier[2]), s = sin(carrier[2]);
    double x = carrier[0] + c * own->x - s * own->y - body[0], y = carrier[1] + s * own->x + c * own->y - body[1];
    out[2] -= x * out[1] - y * out[0];
}

double energy(Instance *it, int which) {
    const double *q = numbers(it, AT_Y), *v = q + N3, *m = numbers(it, AT_INERTIA), *weight = numbers(it, AT_WEIGHT);
    double out = 0.0;
    for (int c = 3; c < 3 * BODIES; c++) out += which == 0 ? 0.5 * m[c] * v[c] * v[c] : c % 3 < 2 ? -weight[c] * q[c] : 0.0;
    return out;
}

static void set_entry(Instance *it, int entry, double value) {
    numbers(it, AT_INERTIA)[entry] = value;
    numbers(it, AT_INVERSE)[entry] = numbers(it, AT_METRIC)[entry] = 1.0 / value;
    if (entry % 3 < 2) numbers(it, AT_WEIGHT)[entry] = value * numbers(it, AT_GRAVITY)[entry % 3];
}

void set_mass(Instance *it, int body, double mass) {
    numbers(it, AT_MASS)[body] = mass;
    set_entry(it, 3 * body, mass);
    set_entry(it, 3 * body + 1, mass);
}

void set_inertia(Instance *it, int body, double inertia) {
    numbers(it, AT_TURNING)[body] = inertia;
    set_entry(it, 3 * body + 2, inertia);
}

void set_gravity(Instance *it, int component, double value) {
    numbers(it, AT_GRAVITY)[component] = value;
    for (int body = 1; body < BODIES; body++)
        numbers(it, AT_WEIGHT)[3 * body + component] = value * numbers(it, AT_INERTIA)[3 * body + component];
}

/* The law goes on where it stands: its numbers are value at t = 0 and rate. */
void set_rate(Instance *it, int driver, int64_t place, double rate) {
    (void)driver;
    double *law = numbers(it, place);
    law[0] += (law[1] - rate) * it->kept.time;
    law[1] = rate;
}
