/* The paper's hacksaw once more, by a program that shares nothing with the rest: written in C from the project's specification
 * alone, in the plane, in quad precision. Its table `independent.csv` is what the stored reference `paper.csv` is held against.
 *
 *     gcc -O2 -o independent independent.c -lquadmath && ./independent 1e-20 > independent.csv
 *
 * takes some minutes; the argument is the largest estimated error of a step over 1 + |x|, SI.
 *
 * States of each link: place of the centre of mass, angle, momentum, angular momentum about the centre of mass. Method:
 * Gragg's midpoint rule extrapolated after Bulirsch and Stoer, 12 columns (Hairer, Norsett, Wanner, Solving Ordinary
 * Differential Equations I, section II.9). Steps end at the instants and where the blade's slip velocity is zero. Constants are
 * decimal numbers, not those numbers rounded to doubles. */
#include <quadmath.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef __float128 real;

enum { CRANK, ROD, FRAME, GUIDE, LINKS, GROUND };
enum { X, Y, ANGLE, PX, PY, H, EACH };
enum { STATES = LINKS * EACH, COLUMNS = 12, INSTANTS = 501 };

static real mass[LINKS], inertia[LINKS];
/* Centre of mass of frame and guide above the bar's and the block's centre, m. */
static real frame_centre, guide_centre;
static int cutting;

/* What follows from a state: sine and cosine of the angles, velocities; and the forces and moments summed up so far. */
static const real *state;
static real sine[LINKS], cosine[LINKS], velocity[LINKS][3], load[LINKS][3];

typedef struct { real x, y, vx, vy; } point;

static void look_at(const real *s) {
    state = s;
    for (int i = 0; i < LINKS; i++) {
        sincosq(s[EACH * i + ANGLE], &sine[i], &cosine[i]);
        velocity[i][0] = s[EACH * i + PX] / mass[i];
        velocity[i][1] = s[EACH * i + PY] / mass[i];
        velocity[i][2] = s[EACH * i + H] / inertia[i];
    }
}

/* A point of a link, given from its centre of mass in its axes. */
static point of_link(int link, real x, real y) {
    real rx = cosine[link] * x - sine[link] * y, ry = sine[link] * x + cosine[link] * y;
    const real *v = velocity[link], *s = state + EACH * link;
    return (point){s[X] + rx, s[Y] + ry, v[0] - v[2] * ry, v[1] + v[2] * rx};
}

/* Place and velocity of a point as a link sees it, from its centre of mass in its axes. */
static point seen_from(int link, point p) {
    const real *v = velocity[link], *s = state + EACH * link;
    real dx = p.x - s[X], dy = p.y - s[Y], c = cosine[link], n = sine[link];
    real vx = p.vx - v[0] + v[2] * dy, vy = p.vy - v[1] - v[2] * dx;
    return (point){c * dx + n * dy, -n * dx + c * dy, c * vx + n * vy, -n * vx + c * vy};
}

static void push(int link, point at, real fx, real fy) {
    if (link == GROUND) return;
    load[link][0] += fx;
    load[link][1] += fy;
    load[link][2] += (at.x - state[EACH * link + X]) * fy - (at.y - state[EACH * link + Y]) * fx;
}

/* A force given in the frame's axes. */
static void push_turned(int link, point at, real fx, real fy) {
    push(link, at, cosine[FRAME] * fx - sine[FRAME] * fy, sine[FRAME] * fx + cosine[FRAME] * fy);
}

static void pin(int i, point a, int j, point b, real k, real r) {
    real fx = k * (a.x - b.x) + r * (a.vx - b.vx), fy = k * (a.y - b.y) + r * (a.vy - b.vy);
    push(j, b, fx, fy);
    push(i, a, -fx, -fy);
}

static const point ORIGIN = {0, 0, 0, 0}, PIVOT = {0.9Q, 0.745Q, 0, 0}, WORK = {0.9Q, -0.145Q, 0, 0};

/* The velocity of the blade past the work piece along the frame, m/s. */
static real slip(const real *s) {
    look_at(s);
    return -seen_from(FRAME, WORK).vx;
}

static void rate(const real *s, real *ds) {
    look_at(s);
    memset(load, 0, sizeof load);
    pin(GROUND, ORIGIN, CRANK, of_link(CRANK, -0.0375Q, 0), 1e7Q, 0.5Q);
    pin(CRANK, of_link(CRANK, 0.0375Q, 0), ROD, of_link(ROD, -0.35Q, 0), 1e7Q, 1e2Q);
    pin(ROD, of_link(ROD, 0.35Q, 0), FRAME, of_link(FRAME, -0.2Q, -frame_centre), 1e8Q, 0.5Q);
    pin(GROUND, PIVOT, GUIDE, of_link(GUIDE, 0, 0.745Q - guide_centre), 1e6Q, 1e1Q);

    point block = of_link(GUIDE, 0, -guide_centre), offset = seen_from(FRAME, block);
    real force = -(1e7Q * (offset.y + frame_centre) + 1e2Q * offset.vy);
    push_turned(GUIDE, block, 0, force);
    push_turned(FRAME, block, 0, -force);
    real twist = state[EACH * GUIDE + ANGLE] - state[EACH * FRAME + ANGLE];
    real moment = -(1e4Q * twist + 1e2Q * (velocity[GUIDE][2] - velocity[FRAME][2]));
    load[GUIDE][2] += moment;
    load[FRAME][2] -= moment;

    point work = seen_from(FRAME, WORK);
    real up = (-0.145Q - frame_centre) - work.y;
    push_turned(FRAME, WORK, (cutting ? 1e2Q : 1e1Q) * work.vx, -(1e2Q * up - 1e2Q * work.vy));

    load[CRANK][2] += 1e1Q;
    for (int i = 0; i < LINKS; i++) {
        load[i][1] -= 9.81Q * mass[i];
        memcpy(ds + EACH * i + X, velocity[i], sizeof velocity[i]);
        memcpy(ds + EACH * i + PX, load[i], sizeof load[i]);
    }
}

/* One step of size h from s; gives the estimated error over 1 + |x|. */
static real step(const real *s, real h, real *end) {
    static real first[STATES], a[STATES], b[STATES], ds[STATES], row[COLUMNS][STATES], above[COLUMNS][STATES];
    rate(s, first);
    for (int j = 0; j < COLUMNS; j++) {
        int parts = 2 * (j + 1);
        real part = h / parts;
        for (int i = 0; i < STATES; i++) a[i] = s[i], b[i] = s[i] + part * first[i];
        for (int k = 1; k < parts; k++) {
            rate(b, ds);
            for (int i = 0; i < STATES; i++) {
                real next = a[i] + 2 * part * ds[i];
                a[i] = b[i];
                b[i] = next;
            }
        }
        rate(b, ds);
        for (int i = 0; i < STATES; i++) row[0][i] = (a[i] + b[i] + part * ds[i]) / 2;
        for (int l = 1; l <= j; l++) {
            real ratio = (real)(j + 1) / (j + 1 - l);
            for (int i = 0; i < STATES; i++) row[l][i] = row[l - 1][i] + (row[l - 1][i] - above[l - 1][i]) / (ratio * ratio - 1);
        }
        memcpy(above, row, sizeof row);
    }
    real error = 0;
    for (int i = 0; i < STATES; i++) {
        end[i] = row[COLUMNS - 1][i];
        error = fmaxq(error, fabsq(end[i] - row[COLUMNS - 2][i]) / (1 + fabsq(s[i])));
    }
    return error;
}

/* The stroke a moment after s. */
static int cuts_after(const real *s) {
    real end[STATES];
    step(s, 1e-9Q, end);
    return slip(end) < 0;
}

/* The size, at most h, of the step from s to where the slip is zero; the slip at h is `last`, and of the other sign than before. */
static real to_the_event(const real *s, real h, real last, real *end) {
    real low = 0, high = h, at_low = -last, at_high = last, size = h / 2;
    for (int tries = 0; tries < 200; tries++) {
        step(s, size, end);
        real here = slip(end);
        if (fabsq(here) < 1e-28Q || high - low < 1e-30Q) break;
        if ((here < 0) == (at_low < 0)) low = size, at_low = here;
        else high = size, at_high = here;
        real secant = high - at_high * (high - low) / (at_high - at_low);
        /* Every third time the middle, so that both ends move. */
        int inside = low > 0 && secant > low && secant < high;
        size = inside && tries % 3 != 2 ? secant : (low + high) / 2;
    }
    return size;
}

/* Mass, inertia and height of the centre of mass of cuboids of one depth: edges a and b, centre (x, y), symmetric in x. */
static real solid(int link, real depth, int count, const real (*part)[4]) {
    real area = 0, first = 0, second = 0;
    for (int i = 0; i < count; i++) area += part[i][0] * part[i][1], first += part[i][0] * part[i][1] * part[i][3];
    real centre = first / area;
    for (int i = 0; i < count; i++) {
        real a = part[i][0], b = part[i][1], x = part[i][2], y = part[i][3] - centre;
        second += a * b * ((a * a + b * b) / 12 + x * x + y * y);
    }
    mass[link] = 7850 * depth * area;
    inertia[link] = 7850 * depth * second;
    return centre;
}

static void print(int hundredths, const real *s) {
    char text[64];
    printf("%d.%02d", hundredths / 100, hundredths % 100);
    for (int i = 0; i < STATES; i++) {
        /* Angles less whole turns: what an orientation says of them. */
        const real value = i % EACH == ANGLE ? remainderq(s[i], 2 * M_PIq) : s[i];
        quadmath_snprintf(text, sizeof text, "%.17Qg", value);
        printf(",%s", text);
    }
    putchar('\n');
}

int main(int count, char **arguments) {
    if (count != 2) return fputs("one argument: the tolerance\n", stderr), 2;
    const real tolerance = strtoflt128(arguments[1], NULL);
    static const real crank[][4] = {{0.075Q, 0.04Q, 0, 0}}, rod[][4] = {{0.7Q, 0.04Q, 0, 0}};
    static const real frame[][4] = {{0.4Q, 0.03Q, 0, 0}, {0.03Q, 0.13Q, -0.185Q, -0.08Q}, {0.03Q, 0.13Q, 0.185Q, -0.08Q}};
    static const real guide[][4] = {{0.1Q, 0.09Q, 0, 0}, {0.09Q, 0.7Q, 0, 0.395Q}};
    solid(CRANK, 0.02Q, 1, crank);
    solid(ROD, 0.03Q, 1, rod);
    frame_centre = solid(FRAME, 0.03Q, 3, frame);
    guide_centre = solid(GUIDE, 0.03Q, 2, guide);

    /* At rest, all springs unloaded, crank along +x: then everything is level and upright. */
    real s[STATES] = {0}, end[STATES], t = 0, h = 1e-7Q;
    s[EACH * CRANK + X] = 0.0375Q;
    s[EACH * ROD + X] = 0.425Q;
    s[EACH * FRAME + X] = 0.975Q, s[EACH * FRAME + Y] = frame_centre;
    s[EACH * GUIDE + X] = 0.9Q, s[EACH * GUIDE + Y] = guide_centre;
    cutting = 1;
    cutting = cuts_after(s);

    fputs("t", stdout);
    for (int link = 2; link <= 5; link++) printf(",C%1$d_x,C%1$d_y,angle%1$d,p%1$d_x,p%1$d_y,h%1$d_z", link);
    putchar('\n');
    int steps = 0, rejected = 0, events = 0;
    for (int k = 0; k < INSTANTS; k++) {
        const real instant = k / (real)100;
        while (t < instant) {
            const int last = t + h >= instant;
            const real size = last ? instant - t : h;
            const real error = step(s, size, end), pace = 0.85Q * powq(tolerance / error, 1.0Q / (2 * COLUMNS - 1));
            if (error > tolerance) {
                h = size * fmaxq(pace, 0.2Q);
                rejected++;
                continue;
            }
            const real after = slip(end);
            steps++;
            if ((after < 0) != cutting) {
                t += to_the_event(s, size, after, end);
                memcpy(s, end, sizeof s);
                cutting = cuts_after(s);
                events++;
                h = 1e-6Q;
                continue;
            }
            t = last ? instant : t + size;
            memcpy(s, end, sizeof s);
            /* A step cut short by an instant is no reason for short ones after it. */
            const real next = size * fminq(fmaxq(pace, 0.5Q), 1.5Q);
            h = last ? fmaxq(h, next) : next;
        }
        print(k, s);
    }
    fprintf(stderr, "%d steps, %d rejected, %d events\n", steps, rejected, events);
}
