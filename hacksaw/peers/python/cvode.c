/* CVODE on the planar hacksaw, called as from a C program: right-hand side, root function, output and the loop are C.
 *
 * In: the model's constants, the start, the sample times, tolerances, the method. Out: the poses at the samples and counts.
 * The functions of SUNDIALS 7 are declared here, so that only the libraries in the Python package are needed; a change of
 * their meaning would show in the error. The cutting law's switches are CVODE's roots: at each one the resistance becomes
 * that of the slip's sign a moment later and CVODE starts again there (CVodeReInit), as its manual asks for.
 */
#define _GNU_SOURCE
#include <math.h>
#include <stddef.h>

typedef struct Context_ *SUNContext;
typedef struct Vector_ *N_Vector;
typedef struct Matrix_ *SUNMatrix;
typedef struct LinearSolver_ *SUNLinearSolver;
typedef struct NonlinearSolver_ *SUNNonlinearSolver;

int SUNContext_Create(int comm, SUNContext *context);
int SUNContext_Free(SUNContext *context);
N_Vector N_VNew_Serial(long length, SUNContext context);
double *N_VGetArrayPointer(N_Vector v);
void N_VDestroy(N_Vector v);
SUNMatrix SUNDenseMatrix(long rows, long columns, SUNContext context);
void SUNMatDestroy(SUNMatrix a);
SUNLinearSolver SUNLinSol_Dense(N_Vector y, SUNMatrix a, SUNContext context);
int SUNLinSolFree(SUNLinearSolver s);
SUNNonlinearSolver SUNNonlinSol_FixedPoint(N_Vector y, int acceleration, SUNContext context);
int SUNNonlinSolFree(SUNNonlinearSolver s);
void *CVodeCreate(int method, SUNContext context);
int CVodeInit(void *memory, int (*rhs)(double, N_Vector, N_Vector, void *), double t0, N_Vector y0);
int CVodeReInit(void *memory, double t0, N_Vector y0);
int CVodeSStolerances(void *memory, double relative, double absolute);
int CVodeSetUserData(void *memory, void *data);
int CVodeSetMaxNumSteps(void *memory, long steps);
int CVodeSetMaxErrTestFails(void *memory, int fails);
int CVodeSetMaxConvFails(void *memory, int fails);
int CVodeSetStopTime(void *memory, double t);
int CVodeSetLinearSolver(void *memory, SUNLinearSolver s, SUNMatrix a);
int CVodeSetNonlinearSolver(void *memory, SUNNonlinearSolver s);
int CVodeRootInit(void *memory, int roots, int (*root)(double, N_Vector, double *, void *));
int CVode(void *memory, double t_out, N_Vector y, double *t, int task);
int CVodeGetDky(void *memory, double t, int k, N_Vector y);
int CVodeGetNumSteps(void *memory, long *count);
int CVodeGetNumRhsEvals(void *memory, long *count);
int CVodeGetNumErrTestFails(void *memory, long *count);
void CVodeFree(void **memory);

enum { ADAMS = 1, BDF = 2, NORMAL = 1, ROOT_RETURN = 2, STATES = 24, POSES = 12 };

/* The constants in the order of `CONSTANTS` in cvode.py; pins are stiffness, N/m, and damping, N s/m. */
typedef struct {
    double torque, gravity, masses[4], inertias[4];
    double pin_o[2], pin_a[2], pin_b[2], pin_c[2], slot[2], twist[2], work[2];
    double r_cut, r_return, b4[2], bar, blade, block, pivot, crank, rod, o5[2], work_point[2];
} Model;

typedef struct {
    const Model *model;
    int cutting;
} Branch;

typedef struct {
    double x, y, vx, vy;
} Point;

/* A link with the forces and the moment about its centre of mass that were applied so far. */
typedef struct {
    double x, y, angle, vx, vy, w, sine, cosine, fx, fy, moment;
} Link;

static inline Link link_of(const double *s, int i) {
    Link l = {s[3 * i], s[3 * i + 1], s[3 * i + 2], s[12 + 3 * i], s[13 + 3 * i], s[14 + 3 * i], 0, 0, 0, 0, 0};
    sincos(l.angle, &l.sine, &l.cosine);
    return l;
}

static inline Point point(const Link *l, double x, double y) {
    double dx = l->cosine * x - l->sine * y, dy = l->sine * x + l->cosine * y;
    return (Point){l->x + dx, l->y + dy, l->vx - l->w * dy, l->vy + l->w * dx};
}

/* Place and velocity of a point as seen from the link, in its axes. */
static inline Point seen(const Link *l, Point p) {
    double dx = p.x - l->x, dy = p.y - l->y, s = l->sine, c = l->cosine;
    double vx = p.vx - l->vx + l->w * dy, vy = p.vy - l->vy - l->w * dx;
    return (Point){c * dx + s * dy, c * dy - s * dx, c * vx + s * vy, c * vy - s * vx};
}

static inline void apply(Link *l, double fx, double fy, Point at) {
    l->fx += fx;
    l->fy += fy;
    l->moment += (at.x - l->x) * fy - (at.y - l->y) * fx;
}

/* A pin's force on the link of `b`, its reaction on that of `a`. */
static inline void join(const double *pin, Link *one, Point a, Link *other, Point b) {
    double fx = pin[0] * (a.x - b.x) + pin[1] * (a.vx - b.vx), fy = pin[0] * (a.y - b.y) + pin[1] * (a.vy - b.vy);
    apply(other, fx, fy, b);
    if (one) apply(one, -fx, -fy, a);
}

static void rate(const Model *m, int cutting, const double *restrict s, double *restrict out) {
    Link l[4] = {link_of(s, 0), link_of(s, 1), link_of(s, 2), link_of(s, 3)};
    Link *crank = &l[0], *rod = &l[1], *frame = &l[2], *guide = &l[3];
    Point block = point(guide, 0, m->block);
    join(m->pin_o, NULL, (Point){0, 0, 0, 0}, crank, point(crank, -m->crank, 0));
    join(m->pin_a, crank, point(crank, m->crank, 0), rod, point(rod, -m->rod, 0));
    join(m->pin_b, rod, point(rod, m->rod, 0), frame, point(frame, m->b4[0], m->b4[1]));
    join(m->pin_c, NULL, (Point){m->o5[0], m->o5[1], 0, 0}, guide, point(guide, 0, m->pivot));

    Point in_frame = seen(frame, block);
    double slot = m->slot[0] * (in_frame.y - m->bar) + m->slot[1] * in_frame.vy;
    double fx = -frame->sine * slot, fy = frame->cosine * slot;
    apply(frame, fx, fy, block);
    apply(guide, -fx, -fy, block);
    double twist = m->twist[0] * (guide->angle - frame->angle) + m->twist[1] * (guide->w - frame->w);
    frame->moment += twist;
    guide->moment -= twist;

    Point work = {m->work_point[0], m->work_point[1], 0, 0}, slip = seen(frame, work);
    double along = (cutting ? m->r_cut : m->r_return) * slip.vx;
    double across = m->work[0] * (slip.y - m->blade) + m->work[1] * slip.vy;
    apply(frame, frame->cosine * along - frame->sine * across, frame->sine * along + frame->cosine * across, work);
    crank->moment += m->torque;

    for (int i = 0; i < 4; i++) {
        out[3 * i] = l[i].vx;
        out[3 * i + 1] = l[i].vy;
        out[3 * i + 2] = l[i].w;
        out[12 + 3 * i] = m->masses[i] * l[i].fx;
        out[13 + 3 * i] = m->masses[i] * l[i].fy - m->gravity;
        out[14 + 3 * i] = m->inertias[i] * l[i].moment;
    }
}

/* The velocity of the blade at the work point along the frame, m/s; negative while cutting. */
static double slip_velocity(const Model *m, const double *s) {
    double ex = m->work_point[0] - s[6], ey = m->work_point[1] - s[7];
    return cos(s[8]) * (s[18] - s[20] * ey) + sin(s[8]) * (s[19] + s[20] * ex);
}

static int cuts_after(const Model *m, const double *s) {
    double d[STATES], later[STATES];
    rate(m, 1, s, d);
    for (int i = 0; i < STATES; i++) later[i] = s[i] + 1e-7 * d[i];
    return slip_velocity(m, later) < 0;
}

static int rhs(double t, N_Vector y, N_Vector dy, void *data) {
    const Branch *branch = data;
    (void)t;
    rate(branch->model, branch->cutting, N_VGetArrayPointer(y), N_VGetArrayPointer(dy));
    return 0;
}

static int root(double t, N_Vector y, double *g, void *data) {
    (void)t;
    g[0] = slip_velocity(((const Branch *)data)->model, N_VGetArrayPointer(y));
    return 0;
}

/* Adds what CVODE counted since its last start to `counts`: steps, rejected steps, rates. */
static void count(void *memory, long *counts) {
    long steps = 0, rates = 0, fails = 0;
    CVodeGetNumSteps(memory, &steps);
    CVodeGetNumErrTestFails(memory, &fails);
    CVodeGetNumRhsEvals(memory, &rates);
    counts[0] += steps;
    counts[1] += fails;
    counts[2] += rates;
}

/* Integrates from `start` over the `samples` instants of `times`, the first being the start, and writes the poses at each
 * into `poses`. `counts` gets steps, rejected steps, rates without those of Jacobians, events. Gives 0 or CVODE's flag. */
int run(const Model *model, const double *start, int cutting, const double *times, int samples, int method,
        double relative, double absolute, double *poses, long *counts) {
    SUNContext context = NULL;
    if (SUNContext_Create(0, &context)) return -100;
    N_Vector y = N_VNew_Serial(STATES, context);
    double *state = N_VGetArrayPointer(y), t = times[0];
    for (int i = 0; i < STATES; i++) state[i] = start[i];
    for (int i = 0; i < POSES; i++) poses[i] = start[i];
    for (int i = 0; i < 4; i++) counts[i] = 0;
    Branch branch = {model, cutting};
    void *memory = CVodeCreate(method, context);
    CVodeInit(memory, rhs, t, y);
    CVodeSStolerances(memory, relative, absolute);
    CVodeSetUserData(memory, &branch);
    CVodeSetMaxNumSteps(memory, 1000000000L);
    CVodeSetMaxErrTestFails(memory, 100);
    CVodeSetMaxConvFails(memory, 100);
    CVodeRootInit(memory, 1, root);
    SUNMatrix a = NULL;
    SUNLinearSolver linear = NULL;
    SUNNonlinearSolver fixed_point = NULL;
    if (method == BDF) {
        a = SUNDenseMatrix(STATES, STATES, context);
        linear = SUNLinSol_Dense(y, a, context);
        CVodeSetLinearSolver(memory, linear, a);
    } else {
        fixed_point = SUNNonlinSol_FixedPoint(y, 0, context);
        CVodeSetNonlinearSolver(memory, fixed_point);
    }
    /* Not beyond the end; elsewhere CVODE steps over the samples and interpolates. */
    CVodeSetStopTime(memory, times[samples - 1]);
    int flag = 0;
    for (int k = 1; k < samples && flag >= 0;) {
        flag = CVode(memory, times[k], y, &t, NORMAL);
        if (flag == ROOT_RETURN) {
            branch.cutting = cuts_after(model, state);
            count(memory, counts);
            counts[3]++;
            flag = CVodeReInit(memory, t, y);
            CVodeSetStopTime(memory, times[samples - 1]);
        } else if (flag >= 0) {
            for (int i = 0; i < POSES; i++) poses[POSES * k + i] = state[i];
            k++;
        }
    }
    count(memory, counts);
    CVodeFree(&memory);
    if (linear) SUNLinSolFree(linear);
    if (a) SUNMatDestroy(a);
    if (fixed_point) SUNNonlinSolFree(fixed_point);
    N_VDestroy(y);
    SUNContext_Free(&context);
    return flag < 0 ? flag : 0;
}
