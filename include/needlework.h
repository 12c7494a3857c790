/* The C interface of Needlework, for programs in C, Fortran and other languages that can call C.
 *
 * Link with libneedlework.so, or by pkg-config needlework, or by CMake:
 * find_package(Needlework COMPONENTS c) and needlework::c. docs/c.md is the guide; examples/ has
 * complete programs in C and Fortran.
 *
 * Units are those of the scene: needles have length 1 and mass 1 unless it has [[species]]. Vectors
 * have one row of three numbers for each needle. Structures are best set to {0} before their
 * members are, so that members which are not named count as not given.
 *
 * Errors. Functions return a code of needlework_code, whose values are the program's exit codes.
 * The message of a function with a simulation is needlework_message(simulation), that of a function
 * without one is written to the needlework_error passed to it (NULL: not wanted). The library
 * throws no exception to its caller, never ends the process, prints nothing, and changes no signal
 * handler and no setting of OpenMP or HDF5 beyond a call. Calls that read an HDF5 file (a scene
 * with initial.file, needlework_resume()) fork: the file is read in a child process with limits of
 * memory and time, which ends before the call returns and for which the caller gets a SIGCHLD.
 * Where the environment variable NEEDLEWORK_FORK is 0 they do not, and a file made to crash HDF5
 * then ends the process. It computes in the default floating-point environment, whatever that of
 * the caller is, and leaves the caller's as it was. A function that fails changes nothing, except
 * where it says so. If memory runs out while a simulation runs, a needle has crossed 2^31 boxes
 * along an axis, or a defect of the library is found in the middle of an event, every function on
 * it returns NEEDLEWORK_INVALID_STATE from then on; what its file holds stays.
 *
 * Threads. Each function says in square brackets which calls may run at the same time:
 *   [any]     with every other function
 *   [handle]  with every function on other simulations. A call on a simulation that another thread
 *             uses at that moment, or from its own callback, returns NEEDLEWORK_USAGE at once.
 *   [signal]  with every other function, also in a signal handler and in a callback
 * A thread must not be cancelled (pthread_cancel) in a call. Calls that read or write files exclude
 * each other, but not HDF5 calls of the caller in other threads: those need a thread-safe build of
 * HDF5, such as Debian's. */
#ifndef NEEDLEWORK_H
#define NEEDLEWORK_H

#include <stddef.h>
#include <stdint.h>

#if defined(__GNUC__)
#define NEEDLEWORK_API __attribute__((visibility("default")))
#else
#define NEEDLEWORK_API
#endif

#ifdef __cplusplus
extern "C" {
#endif

/* ---- Errors ---------------------------------------------------------------------------------- */

enum needlework_code {
  NEEDLEWORK_OK = 0,
  NEEDLEWORK_USAGE = 2,         /* an argument that is NULL or impossible, or a call not allowed */
  NEEDLEWORK_INPUT = 3,         /* a scene, state or file that cannot be used; too little memory */
  NEEDLEWORK_INVALID_STATE = 4, /* the simulation cannot go on correctly */
  NEEDLEWORK_IO = 5             /* a file that cannot be read or written */
};

typedef struct needlework_error {
  int code;           /* of needlework_code */
  char message[1024]; /* one line, cut off if it is longer; empty if the code is NEEDLEWORK_OK, but
                         for a warning of the functions that make a simulation */
} needlework_error;

/* ---- Version and capabilities ---------------------------------------------------------------- */

/* The version, such as "1.0.0". [any] */
NEEDLEWORK_API const char* needlework_version(void);

/* 1 if this library on this machine has what is named, else 0: "isa/scalar", "isa/sse4",
 * "isa/avx2", "isa/avx512" (instruction sets), "threads" (several threads for a simulation),
 * "files/h5md" (reading and writing files), "effect/NAME" with a NAME that
 * needlework_setting(simulation, "effects") may give, such as "effect/growth". [any] */
NEEDLEWORK_API int needlework_has(const char* capability);

/* ---- Making a simulation --------------------------------------------------------------------- */

typedef struct needlework_simulation needlework_simulation;

enum needlework_flag {
  NEEDLEWORK_REPLACE = 1 /* replace a file that exists; without it that is NEEDLEWORK_IO, as it is
                            for a file that a program or another simulation is writing */
};

/* One vector for each needle: data[n * row + axis * column] is the component `axis` of needle n.
 * Both strides count numbers; 0 stands for 3 and 1, which is double data[N][3]. */
typedef struct needlework_vectors {
  double* data; /* NULL: absent, or not wanted */
  ptrdiff_t row, column;
} needlework_vectors;

typedef struct needlework_const_vectors {
  const double* data; /* NULL: absent */
  ptrdiff_t row, column;
} needlework_const_vectors;

/* The state to start from. The scene's count and box, where given, must agree with it. Positions
 * beyond the box are moved into it, which counts as crossings of its borders. */
typedef struct needlework_initial {
  size_t count;
  double box[3];                              /* edges; all 0: those of the scene */
  needlework_const_vectors position;          /* centres, inside the box or not */
  needlework_const_vectors velocity;          /* absent: all 0 */
  needlework_const_vectors orientation;       /* directors, of any length but 0 */
  needlework_const_vectors angular_velocity;  /* of which the part normal to the director counts,
                                                 of spheres all; absent: all 0 */
  const uint32_t* id;                         /* distinct; NULL: 0 to count - 1 */
  needlework_const_vectors peculiar_velocity; /* in place of velocity, which must be absent:
                                                 beside the flow of [shear] */
  double slide;  /* of the row of boxes above in [shear], where the scene gives no offset */
  double low[3]; /* where the low edges are; the run that begins moves them to 0 */
} needlework_initial;

/* Makes a simulation of a scene in TOML, as docs/scenes.md describes it; [until] may be missing.
 * The initial state is drawn, or read from initial.file. If the scene names output.file, that file
 * is written as the program `needlework run` writes it. NEEDLEWORK_ISA and OMP_NUM_THREADS count as
 * they do for the program. `flags` is 0 or NEEDLEWORK_REPLACE. On file systems without locks
 * `error` has a warning with the code NEEDLEWORK_OK: other programs that write to the output file
 * cannot be noticed. Returns NULL on failure. The caller destroys the simulation. [any] */
NEEDLEWORK_API needlework_simulation* needlework_create(const char* scene, unsigned flags,
                                                        needlework_error* error);
/* The same for a scene in a file. [any] */
NEEDLEWORK_API needlework_simulation* needlework_open(const char* path, unsigned flags,
                                                      needlework_error* error);
/* The same from a state of the caller's, which is copied. The scene must have neither initial.file
 * nor temperatures, and needs neither needles.count nor needles.box. Images count from 0. [any] */
NEEDLEWORK_API needlework_simulation* needlework_create_from(const char* scene,
                                                             const needlework_initial* initial,
                                                             unsigned flags,
                                                             needlework_error* error);
/* The same with images that go on from image[initial->count][3], by the rows of `initial`, such as
 * those of needlework_get_state(): from -(2^31 - 1) to 2^31 - 1. NULL: they count from 0. [any] */
NEEDLEWORK_API needlework_simulation* needlework_create_with_images(
    const char* scene, const needlework_initial* initial, const int32_t* image, unsigned flags,
    needlework_error* error);
/* The same for needles of several species: species[initial->count], by the rows of `initial`, has
 * indices from 0 into the scene's [[species]], whose counts, where given, must agree. NULL: ids go
 * through the species in the order of the scene, as many of each as it counts. [any] */
NEEDLEWORK_API needlework_simulation* needlework_create_with_species(
    const char* scene, const needlework_initial* initial, const int32_t* image,
    const uint8_t* species, unsigned flags, needlework_error* error);

/* Makes a simulation that continues the run of an output file from its last checkpoint, beside it:
 * the same collisions, to the last bit, as if the run had never ended, and the same file goes on.
 * Time, counts and limits go on from the start of the run. The engine is chosen for this machine as
 * by needlework_create(), with the threads of before; a function for collisions has to be set
 * again. If the newest checkpoint is damaged, the one before is used, and `error` has a warning
 * with the code NEEDLEWORK_OK. Returns NULL on failure: NEEDLEWORK_INPUT if the file has no
 * checkpoint to continue from, or if it is not that of the file; NEEDLEWORK_IO if the file is
 * missing, cannot be written, or is written by another simulation. The caller destroys the
 * simulation. [any] */
NEEDLEWORK_API needlework_simulation* needlework_resume(const char* file, needlework_error* error);

/* Frees a simulation; NULL is allowed. The output file ends with the last sample that was due, and
 * no checkpoint is saved; call needlework_close() first for both at the end. No other call may use
 * the simulation, nor may this be called from its callback. */
NEEDLEWORK_API void needlework_destroy(needlework_simulation* simulation);

/* The message of the last call on this simulation that failed, or ""; while another call uses the
 * simulation, a message that says so. Valid until the next call that fails. [handle] */
NEEDLEWORK_API const char* needlework_message(const needlework_simulation* simulation);

/* ---- Running --------------------------------------------------------------------------------- */

/* Conditions of which the first one met ends the call. 0: no such condition. None may be negative,
 * and one must be set. */
typedef struct needlework_limits {
  double time;
  uint64_t collisions;          /* of all needles together */
  double collisions_per_needle; /* 2 collisions / N */
  double energy_ratio;          /* energy at most this share of that at the start, or at present */
  double wall_s;                /* wall-clock time of this call, in seconds */
} needlework_limits;

enum needlework_stop {
  NEEDLEWORK_STOP_TIME = 0,
  NEEDLEWORK_STOP_COLLISIONS = 1, /* of either kind */
  NEEDLEWORK_STOP_ENERGY = 2,
  NEEDLEWORK_STOP_WALL_TIME = 3,
  NEEDLEWORK_STOP_INTERRUPTED = 4,
  NEEDLEWORK_STOP_NOTHING_CAN_HAPPEN = 5, /* and there is no limit on time below the largest,
                                             2^62 mean free times, or 2^62 of a gas at rest */
  NEEDLEWORK_STOP_WALLS_MEET = 6, /* walls with a velocity leave the longest body no more room */
  NEEDLEWORK_STOP_JAMMED = 7,     /* they, or growth, press bodies together, which collide ever more
                                     often */
  NEEDLEWORK_STOP_GROWN = 8,      /* bodies have grown to the packing fraction of driving.growth */
  NEEDLEWORK_STOP_PRESSURE = 9,   /* their pressure has come to that of driving.growth */
  NEEDLEWORK_STOP_NO_ROOM = 10    /* an edge of the box leaves bodies that grow no more room */
};

/* Runs until a limit is met, at once if it is met already. Limits count from the start of the
 * simulation; NULL stands for the ends of the scene: [until], and those of driving.growth. `stop`
 * receives a value of needlework_stop (NULL: not wanted). Where a call stops does not change the
 * trajectory. On failure the simulation has come as far as it could: on NEEDLEWORK_INVALID_STATE
 * the state is that before the event that failed, and the message names the bundle for `needlework
 * replay` that lies beside the output file, if there is one; on NEEDLEWORK_IO the output file is
 * complete up to the last sample, and the simulation can be looked at, but not run any further.
 * [handle] */
NEEDLEWORK_API int needlework_run_until(needlework_simulation* simulation,
                                        const needlework_limits* limits, int* stop);
/* The same with limits that count from the present state; NULL is not allowed. [handle] */
NEEDLEWORK_API int needlework_advance(needlework_simulation* simulation,
                                      const needlework_limits* limits, int* stop);

/* Stops the call that is running the simulation soon, or else the next one that runs it at once,
 * with NEEDLEWORK_STOP_INTERRUPTED. NULL is allowed. [signal] */
NEEDLEWORK_API void needlework_interrupt(needlework_simulation* simulation);

/* Saves the simulation now beside its output file, so that needlework_resume() continues it from
 * here, whatever happens to the process; that happens by itself every output.checkpoint_every
 * seconds. All collisions up to now count as handed over to the function for collisions.
 * NEEDLEWORK_USAGE if the simulation has no output file, is closed, or output.checkpoint_every is
 * 0. [handle] */
NEEDLEWORK_API int needlework_checkpoint(needlework_simulation* simulation);

/* Saves the simulation as needlework_checkpoint() does, where that is allowed, adds a sample and a
 * frame at the present time to the output file and closes it. Then, and also if this fails, the
 * simulation can be looked at, but not run. Without an output file, and when called again, it does
 * nothing. [handle] */
NEEDLEWORK_API int needlework_close(needlework_simulation* simulation);

/* ---- Collisions ------------------------------------------------------------------------------ */

/* One collision; vectors and signs refer to the first needle, the one with the lower id. */
typedef struct needlework_collision {
  int64_t epoch;             /* the time is exactly epoch * epoch length + offset */
  double offset;             /* [time] */
  double time;               /* the time rounded to a double [time] */
  uint32_t first, second;    /* ids */
  int32_t shift[3];          /* boxes added to the second needle's recorded centre */
  double arm_first;          /* s12, from the centre to the contact [length] */
  double arm_second;         /* s21 [length] */
  double sin_angle;          /* |u1 x u2| */
  double normal_velocity;    /* before the collision [length / time] */
  double impulse[3];         /* on the first needle [mass length / time] */
  double energy_change;      /* of the total energy, <= 0 up to rounding but for what growth
                                adds */
  uint8_t contact_time_rule; /* 1 if the t_c rule made it elastic */
  struct {                   /* states of both needles just after it */
    double position[3], velocity[3], orientation[3], angular_velocity[3];
  } after[2];
} needlework_collision;

/* Receives collisions in order of time. The array is valid during the call only. Returns 0 to go
 * on, anything else to stop the run soon, with NEEDLEWORK_STOP_INTERRUPTED; the few collisions
 * until it stops are kept for the next call that runs the simulation. It is called by the thread
 * that runs the simulation, in the default floating-point environment. It must not leave by an
 * exception or longjmp, and of functions on this simulation may call only those marked [signal] or
 * [any]. */
typedef int (*needlework_on_collisions)(const needlework_collision* collisions, size_t count,
                                        void* user);

/* Sets the function that is given all collisions from now on, `batch` (at least 1) at once, fewer
 * if memory does not suffice, and the rest at the end of each call that runs the simulation. NULL:
 * none. What was kept for the previous function is dropped. [handle] */
NEEDLEWORK_API int needlework_set_callback(needlework_simulation* simulation, size_t batch,
                                           needlework_on_collisions callback, void* user);

/* What an event is; the same numbers as in /events/kind of files. */
enum needlework_kind {
  NEEDLEWORK_KIND_PAIR = 0,            /* a collision of two needles */
  NEEDLEWORK_KIND_WALL = 1,            /* a hit on a wall: `second` is the index of the wall */
  NEEDLEWORK_KIND_CONTACT_ENTERED = 2, /* two needles have begun to slide on each other */
  NEEDLEWORK_KIND_CONTACT_ENDED = 3,   /* and have ended */
  NEEDLEWORK_KIND_THERMOSTAT = 4,      /* velocities drawn anew by a thermostat */
  NEEDLEWORK_KIND_OTHER = 255
};

/* A collision, or an event of one needle. Of an event of one needle `first` is its id, `second` the
 * index of the wall or 0, `arm_first` that of the tip, `normal_velocity` that of the tip relative
 * to the surface along the normal into the gas; `shift`, `arm_second` and `after[1]` are 0. */
typedef struct needlework_happening {
  uint8_t kind;   /* of needlework_kind; others may be added */
  uint8_t source; /* 0 for events of two needles */
  needlework_collision event;
} needlework_happening;

/* Receives all that happens, as needlework_on_collisions receives collisions. */
typedef int (*needlework_on_happenings)(const needlework_happening* happenings, size_t count,
                                        void* user);

/* Sets such a function, beside that of needlework_set_callback(), and in the same way: NULL ends
 * it. Collisions of two needles are among what it is given. [handle] */
NEEDLEWORK_API int needlework_set_happening_callback(needlework_simulation* simulation,
                                                     size_t batch,
                                                     needlework_on_happenings callback, void* user);

/* ---- State ----------------------------------------------------------------------------------- */

/* Where to copy the state at the present time, by increasing id. What is NULL is not copied. */
typedef struct needlework_state {
  needlework_vectors position; /* inside the box */
  needlework_vectors velocity, orientation, angular_velocity;
  int32_t* image;                       /* [N][3], box crossings along each axis */
  uint32_t* id;                         /* [N] */
  needlework_vectors peculiar_velocity; /* beside the flow of [shear] */
  double* slide;                        /* of the row of boxes above */
  double* low;                          /* [3], where the low edges are: walls may move them */
} needlework_state;

/* The number of needles; 0 for NULL. [any] */
NEEDLEWORK_API size_t needlework_count(const needlework_simulation* simulation);
/* The edges of the box at the present time, as walls with a velocity move them. [handle] */
NEEDLEWORK_API int needlework_get_box(const needlework_simulation* simulation, double box[3]);
/* Copies the state into the caller's arrays of needlework_count() rows, which must not overlap.
 * [handle] */
NEEDLEWORK_API int needlework_get_state(needlework_simulation* simulation,
                                        const needlework_state* into);
/* Writes the state as a file that initial.file of a scene can name. A file that is replaced stays
 * until the new one is complete. `flags` is 0 or NEEDLEWORK_REPLACE. [handle] */
NEEDLEWORK_API int needlework_write_state(needlework_simulation* simulation, const char* path,
                                          unsigned flags);

/* Replaces all velocities at the present time, by increasing id, as needlework_get_state() gives
 * them: with the flow of a shear rate. The part of an angular velocity along the director is
 * removed. Without angular velocities, where that is NULL, they are 0, and needlework_message()
 * says so. Needles that touch stay on their sides; hash, counts and the energy at the start are
 * kept. The output file says in /velocities_set when that was and by how much the energy changed,
 * and kinetic theory is left out of it from then on. A sample or a frame that is due at this
 * instant is taken when the run goes on, and holds the new velocities; needlework_sample() before
 * this call adds one with the old ones. [handle] */
NEEDLEWORK_API int needlework_set_velocities(needlework_simulation* simulation,
                                             const needlework_const_vectors* velocity,
                                             const needlework_const_vectors* angular_velocity);

/* Adds a sample of the present state to the output file, and a frame if `frame` is not 0, unless
 * the file has just got them. NEEDLEWORK_USAGE without an open output file. [handle] */
NEEDLEWORK_API int needlework_sample(needlework_simulation* simulation, int frame);

/* ---- Species --------------------------------------------------------------------------------- */

/* One species of needles, by index from 0 in the order of the scene. A gas of a scene without
 * [[species]] has one. */
typedef struct needlework_species {
  uint64_t count;
  double length, mass, k; /* means where bodies differ; the mass of fixed ones is infinite; length
                             and k of bodies that grow at the start */
  double t_tr, t_rot; /* at the present time: (2/3) <m v^2 / 2> and <I w^2 / 2> of its needles, or
                         <I w^2> / 3 of its rough spheres */
} needlework_species;

/* How needles of two species collide, and how often they have since the start. */
typedef struct needlework_species_pair {
  double epsilon, beta;
  uint64_t collisions;
} needlework_species_pair;

/* The name of a species, "" in a scene without [[species]]; NULL behind the last. Valid as long as
 * the simulation. [handle] */
NEEDLEWORK_API const char* needlework_species_name(needlework_simulation* simulation, size_t index);
/* Properties and temperatures of a species. [handle] */
NEEDLEWORK_API int needlework_get_species(needlework_simulation* simulation, size_t index,
                                          needlework_species* species);
/* Two species, in any order, or one of them twice. [handle] */
NEEDLEWORK_API int needlework_get_species_pair(needlework_simulation* simulation, size_t first,
                                               size_t second, needlework_species_pair* pair);
/* Whether needles of two species meet: 1, or 0 where they pass through each other. [handle] */
NEEDLEWORK_API int needlework_species_meet(needlework_simulation* simulation, size_t first,
                                           size_t second, int* meet);
/* Copies the species of each needle, by increasing id, to an array of needlework_count() indices.
 * [handle] */
NEEDLEWORK_API int needlework_get_species_of_needles(needlework_simulation* simulation,
                                                     uint8_t* species);

/* ---- Rods of finite width -------------------------------------------------------------------- */

/* Room and pressure of rods of finite width, or of spheres. Of needles, packing fraction and virial
 * are 0. */
typedef struct needlework_rods {
  /* numbers of rods */
  /* Share of the volume of the box that rods take up */
  double packing_fraction;
  /* Sum of r12 . dp over the collisions since the start of the run, r12 from the second centre to
   * the first and dp the impulse on the first [mass times length squared per time] */
  double virial;
  /* Mean over the run: N T_tr and a third of what the virial gains in a unit of time, over the
   * volume of the box; where there are walls, what all of them feel, over their area; NaN at its
   * start, and with gravity along an axis with walls [energy per volume] */
  double pressure;
  /* end of numbers */
} needlework_rods;

/* Copies what is known of rods at the present time. [handle] */
NEEDLEWORK_API int needlework_get_rods(needlework_simulation* simulation, needlework_rods* rods);
/* Writes the diameter of a species, 0 of needles, and its moment of inertia about an axis through
 * the centre and normal to its own, 0 of smooth spheres and infinite of other fixed bodies (NULL:
 * not wanted); means where bodies differ, and of bodies that grow the diameter at the start.
 * [handle] */
NEEDLEWORK_API int needlework_get_species_shape(needlework_simulation* simulation, size_t index,
                                                double* diameter, double* inertia);

/* ---- Walls ----------------------------------------------------------------------------------- */

/* Hits on one wall since the start. Walls are indexed in the order of the scene, where "both"
 * counts as low, then high. */
typedef struct needlework_wall {
  int axis; /* 0, 1, 2 for x, y, z */
  int high; /* 1 at the high edge of the box, 0 at the low one */
  /* numbers of walls */
  /* Number of hits, which are no collisions */
  uint64_t hits;
  /* Sum of the magnitudes of their impulses [mass times length per time] */
  double impulse;
  /* Sum of the components of these impulses along the normal into the gas, which thermal walls may
   * draw negative [mass times length per time] */
  double normal_impulse;
  /* Area of the face of the box at the wall [length squared] */
  double area;
  /* Phase of the motion of the wall now, from 0 to 2 pi, so that its surface is off by amplitude
   * times its sine; NaN at rest [radians] */
  double phase;
  /* Energy that hits have put into the gas, per needle; negative: taken out [energy] */
  double energy;
  /* Mean over the run, impulse along the normal over area and time; NaN at its start [energy per
   * volume] */
  double pressure;
  /* Place of its surface along its axis now [length] */
  double place;
  /* Of its energy, what its motion has done as work, per needle; the rest is heat, or what its
   * restitution takes [energy] */
  double work;
  /* Sum of the impulses on the gas, along x [mass times length per time] */
  double impulse_x;
  /* The same along y [mass times length per time] */
  double impulse_y;
  /* The same along z [mass times length per time] */
  double impulse_z;
  /* end of numbers */
} needlework_wall;

/* The number of walls; 0 on failure. [handle] */
NEEDLEWORK_API size_t needlework_wall_count(needlework_simulation* simulation);
/* Copies what is known of a wall. NEEDLEWORK_USAGE for an index behind the last. [handle] */
NEEDLEWORK_API int needlework_get_wall(needlework_simulation* simulation, size_t index,
                                       needlework_wall* wall);

/* ---- Sliding contact ------------------------------------------------------------------------- */

/* Contacts of needles that slide on each other, since the start. */
typedef struct needlework_contacts {
  /* numbers of contacts */
  /* Number of contacts that have begun */
  uint64_t entered;
  /* Number of them that have ended where the force that holds the needles together would pull */
  uint64_t ended_by_force;
  /* Number of them that have ended as a tip was reached; the needles pass each other */
  uint64_t ended_by_tip;
  /* Number of them that have ended as anything else changed the velocities of one of the needles */
  uint64_t ended_by_strike;
  /* Number of collisions whose epsilon was raised, as one of the needles had just touched another
   * one or a wall */
  uint64_t crowded;
  /* Time that pairs have been in contact, of all together, without that of present steps [time] */
  double time;
  /* Share of its time that a needle has been in contact, the mean of all: 2 time / (N t); NaN at
   * the start */
  double share;
  /* end of numbers */
} needlework_contacts;

/* Copies what is known of contacts; all 0 in a scene without collisions.sliding. [handle] */
NEEDLEWORK_API int needlework_get_contacts(needlework_simulation* simulation,
                                           needlework_contacts* contacts);

/* ---- Growth ---------------------------------------------------------------------------------- */

/* Sizes, packing and pressure of bodies that grow. */
typedef struct needlework_growth {
  /* numbers of growth */
  /* Present sizes of bodies in those of the start */
  double scale;
  /* What this scale gains in a unit of time [per time] */
  double rate;
  /* Share of the volume of the box that bodies take up now */
  double packing_fraction;
  /* P V / (N T) by the virial, as it was last measured, over the collisions between two times at
   * which velocities were scaled back; NaN before */
  double pressure;
  /* end of numbers */
} needlework_growth;

/* Copies what is known of bodies that grow; in a scene without driving.growth the scale is 1, the
 * rate 0 and the pressure NaN. [handle] */
NEEDLEWORK_API int needlework_get_growth(needlework_simulation* simulation,
                                         needlework_growth* growth);

/* ---- Pressure tensor ------------------------------------------------------------------------- */

/* Pressure tensor since the start, a mean over the run. The first letter of an index is the axis
 * along which momentum goes, the second its component. */
typedef struct needlework_pressure_tensor {
  /* numbers of pressure_tensor */
  /* P_xx by flights: n <m c_x c_x> [energy per volume] */
  double kinetic_xx;
  /* P_xy by flights [energy per volume] */
  double kinetic_xy;
  /* P_xz by flights [energy per volume] */
  double kinetic_xz;
  /* P_yx by flights, momentum along x that goes along y [energy per volume] */
  double kinetic_yx;
  /* P_yy by flights [energy per volume] */
  double kinetic_yy;
  /* P_yz by flights [energy per volume] */
  double kinetic_yz;
  /* P_zx by flights [energy per volume] */
  double kinetic_zx;
  /* P_zy by flights [energy per volume] */
  double kinetic_zy;
  /* P_zz by flights [energy per volume] */
  double kinetic_zz;
  /* P_xx by collisions: r12_x dp_x between centres [energy per volume] */
  double collisional_xx;
  /* P_xy by collisions [energy per volume] */
  double collisional_xy;
  /* P_xz by collisions [energy per volume] */
  double collisional_xz;
  /* P_yx by collisions, r12_y dp_x [energy per volume] */
  double collisional_yx;
  /* P_yy by collisions [energy per volume] */
  double collisional_yy;
  /* P_yz by collisions [energy per volume] */
  double collisional_yz;
  /* P_zx by collisions [energy per volume] */
  double collisional_zx;
  /* P_zy by collisions [energy per volume] */
  double collisional_zy;
  /* P_zz by collisions [energy per volume] */
  double collisional_zz;
  /* -P_yx [energy per volume] */
  double shear_stress;
  /* Its standard error [energy per volume] */
  double shear_stress_error;
  /* -P_yx over the rate; NaN without shear [energy times time per volume] */
  double viscosity;
  /* Its standard error [energy times time per volume] */
  double viscosity_error;
  /* P_xx - P_yy [energy per volume] */
  double first_normal_difference;
  /* Its standard error [energy per volume] */
  double first_normal_difference_error;
  /* P_yy - P_zz [energy per volume] */
  double second_normal_difference;
  /* Its standard error [energy per volume] */
  double second_normal_difference_error;
  /* end of numbers */
} needlework_pressure_tensor;

/* Copies the pressure tensor; all NaN unless the scene has [shear] or asks for the observable
 * pressure_tensor. [handle] */
NEEDLEWORK_API int needlework_get_pressure_tensor(needlework_simulation* simulation,
                                                  needlework_pressure_tensor* tensor);

/* ---- Data of your own ------------------------------------------------------------------------ */

enum needlework_data_kind { NEEDLEWORK_DATA_BYTES = 0, NEEDLEWORK_DATA_JSON = 1 };

/* Sets data of your own under a name of 1 to 64 bytes of UTF-8, such as the state of a random
 * number generator, or notes: `size` bytes, at most 2^24, of a kind of needlework_data_kind; JSON
 * is checked. NULL removes the name. Checkpoints carry the data, so that a simulation of
 * needlework_resume() has them; the output file has them in /user_data with the time at which they
 * were set, and the file of needlework_write_state() too. [handle] */
NEEDLEWORK_API int needlework_set_data(needlework_simulation* simulation, const char* name,
                                       int kind, const void* data, size_t size);
/* Writes `kind` and `size` of such data, and copies them to `data` if they have at most `capacity`
 * bytes (each NULL: not wanted). NEEDLEWORK_USAGE for a name that has none, and for too small a
 * capacity, after size and kind have been written. [handle] */
NEEDLEWORK_API int needlework_get_data(needlework_simulation* simulation, const char* name,
                                       int* kind, void* data, size_t capacity, size_t* size);
/* The names in alphabetical order, by index from 0; NULL behind the last. Valid until
 * needlework_set_data() is called. [handle] */
NEEDLEWORK_API const char* needlework_data_name(needlework_simulation* simulation, size_t index);

/* ---- Numbers --------------------------------------------------------------------------------- */

typedef struct needlework_totals {
  /* numbers of totals_in_c */
  /* Time since the start of the run [time] */
  double time;
  /* Translational temperature: two thirds of the mean energy of translation [energy] */
  double t_tr;
  /* Rotational temperature: the mean energy of rotation per two degrees of freedom [energy] */
  double t_rot;
  /* Kinetic energy per needle, and that in gravity between walls [energy] */
  double energy;
  /* Energy per needle at the start; NaN without needles [energy] */
  double initial_energy;
  /* Total momentum of all needles [mass times length per time] */
  double momentum[3];
  /* Number of collisions since the start of the run */
  uint64_t collisions;
  /* Number of collisions since the start of the run that the contact-time rule made elastic */
  uint64_t tc_collisions;
  /* Mean free time by kinetic theory, at about the present temperatures; may be infinite [time] */
  double mean_free_time;
  /* Length of an epoch of needlework_collision [time] */
  double epoch_length;
  /* end of numbers */
} needlework_totals;

/* Sums over all needles at the present time. [handle] */
NEEDLEWORK_API int needlework_get_totals(needlework_simulation* simulation,
                                         needlework_totals* totals);

/* What each effect has put into the energy per needle since the start; negative: taken out. The sum
 * is the change of the energy, up to rounding. 0 for effects that the scene has not. */
typedef struct needlework_energy_budget {
  /* numbers of energy_budget */
  /* Energy by collisions of two needles [energy] */
  double pairs;
  /* Energy by hits on each wall, of all [energy] */
  double walls;
  /* Energy by the thermostat [energy] */
  double thermostat;
  /* Energy by kicks [energy] */
  double kicks;
  /* Energy by velocities that a caller has replaced [energy] */
  double velocities_set;
  /* Energy by gravity along periodic axes [energy] */
  double gravity;
  /* Energy by uniform shear [energy] */
  double shear;
  /* Energy by growth, which pushes bodies apart [energy] */
  double growth;
  /* Energy by velocities that are scaled back as bodies grow [energy] */
  double cooling;
  /* end of numbers */
} needlework_energy_budget;

/* The budget of energy at the present time. [handle] */
NEEDLEWORK_API int needlework_get_energy_budget(needlework_simulation* simulation,
                                                needlework_energy_budget* budget);
/* The hash of all collisions so far, in 32 hexadecimal digits and a zero. [handle] */
NEEDLEWORK_API int needlework_get_hash(needlework_simulation* simulation, char hash[33]);
/* The names of the counters of work done, by index from 0; NULL behind the last. [any] */
NEEDLEWORK_API const char* needlework_counter_name(size_t index);
/* The value of a counter. [handle] */
NEEDLEWORK_API int needlework_get_counter(needlework_simulation* simulation, const char* name,
                                          uint64_t* value);
/* What is in use of "search", "queue", "isa" or "effects"; NULL on failure, as for other names.
 * Valid until the next call of this function on the simulation. [handle] */
NEEDLEWORK_API const char* needlework_setting(needlework_simulation* simulation, const char* name);

/* ---- First contacts of pairs ----------------------------------------------------------------- */

/* Pairs of needles of length 1 at time 0, without periodic images. All but `skip` and `accuracy`
 * must be given. */
typedef struct needlework_pairs {
  size_t count;
  needlework_const_vectors r1, u1, v1, w1; /* the first needles: centre, director, velocity, */
  needlework_const_vectors r2, u2, v2, w2; /* angular velocity; the second needles */
  const double* horizon;                   /* [count], 0 or later */
  const unsigned char* skip; /* [count], 1: the pair has just collided at time 0; NULL: all 0 */
  const char* accuracy;      /* "fast", "standard" or "rigorous"; NULL: "standard" */
} needlework_pairs;

/* Writes time and arms of the first contact in (0, horizon] of each pair to arrays of `count`
 * numbers (NULL: not wanted); infinity, NaN and NaN where there is none. On failure the message
 * names the pair, and the results before it are written. [any] */
NEEDLEWORK_API int needlework_predict(const needlework_pairs* pairs, double* time, double* s12,
                                      double* s21, needlework_error* error);

/* What the bodies of each pair measure; arrays [count]. With diameters they are rods of finite
 * width, or spheres where the length is 0, which meet when their axes are as near each other as
 * half the sum of both diameters. */
typedef struct needlework_pair_sizes {
  const double *length1, *length2;     /* of the axes, without the caps; NULL: all 1 */
  const double *diameter1, *diameter2; /* 0: a needle; both of a pair or none. NULL: all 0 */
} needlework_pair_sizes;

/* needlework_predict() for bodies of any size; NULL: needles of length 1. Rods that overlap are
 * NEEDLEWORK_INPUT. [any] */
NEEDLEWORK_API int needlework_predict_with_sizes(const needlework_pairs* pairs,
                                                 const needlework_pair_sizes* sizes, double* time,
                                                 double* s12, double* s21, needlework_error* error);

/* ---- Kinetic theory, for needles of length 1 and mass 1 -------------------------------------- */

/* A gas with k = m L^2 / (2 I) and its restitutions; beta = -1 is smooth. */
typedef struct needlework_gas {
  double k, epsilon, beta;
} needlework_gas;

/* Collisions of one needle per unit time at number density `density`. [any] */
NEEDLEWORK_API int needlework_collision_rate(double k, double density, double t_tr, double t_rot,
                                             double* rate, needlework_error* error);
/* The long-time ratio T_tr / T_rot of a cooling gas; NaN if it does not cool. [any] */
NEEDLEWORK_API int needlework_ratio(const needlework_gas* gas, double* ratio,
                                    needlework_error* error);
/* The cooling curve at `count` times tau = (2/3) sqrt(pi) n t, in any order, from these
 * temperatures at 0. t_tr and t_rot are arrays of `count` numbers (NULL: not wanted). [any] */
NEEDLEWORK_API int needlework_cooling(const needlework_gas* gas, double t_tr0, double t_rot0,
                                      size_t count, const double* tau, double* t_tr, double* t_rot,
                                      needlework_error* error);

/* ---- Bodies that differ within a species ------------------------------------------------------
 */

/* Numbers of each needle, arrays of as many; each NULL: what follows from the scene. */
typedef struct needlework_bodies {
  const double* length;   /* of the axes, without the caps */
  const double* diameter; /* 0: thin needles */
  const double* mass;     /* infinite of fixed needles */
  const double* inertia;  /* about axes through the centre, normal to the needle's; 0 of smooth
                             spheres */
} needlework_bodies;

/* needlework_create_with_species() for such bodies, by the rows of `initial`. NULL: the needles of
 * a species are alike, or as the scene draws them. [any] */
NEEDLEWORK_API needlework_simulation* needlework_create_with_bodies(
    const char* scene, const needlework_initial* initial, const int32_t* image,
    const uint8_t* species, const needlework_bodies* bodies, unsigned flags,
    needlework_error* error);
/* Copies these numbers of each needle, by increasing id, to arrays of needlework_count() numbers
 * (NULL: not wanted), whether they differ or not; of bodies that grow the present ones. [handle] */
NEEDLEWORK_API int needlework_get_bodies(needlework_simulation* simulation, double* length,
                                         double* diameter, double* mass, double* inertia);

#ifdef __cplusplus
}
#endif

#endif
