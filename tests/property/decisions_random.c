/* A trial that is replayed from the tape leaves the same result as the whole script: the
 * simulator's state and the tally, bit for bit. There are hundreds of trials; many of them fail,
 * are caught and take other ways. Random scripts with tasks are compared with a slow model of
 * tasks, every other one in counted time. */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "mcs/script_run.h"
#include "study/trial.h"
#include "support/support.h"

/* The number of trials in full, and the number from which a count of replays has meaning. */
enum { TRIALS = 150, LEAST = 20 };

typedef struct {
    wh_tally_t replayed, whole;
    uint64_t replays;
    uint64_t pushed; /* wafers through their slots, in replays */
} comparison_t;

static void compare_tallies(const wh_tally_t *one, const wh_tally_t *other) {
    assert_int_equal(one->trials, other->trials);
    assert_int_equal(one->met, other->met);
    assert_int_equal(one->ended, other->ended);
    assert_memory_equal(one->events, other->events, sizeof one->events);
    assert_int_equal(one->expectations.count, other->expectations.count);
    for (size_t i = 0; i < one->expectations.count; ++i) {
        assert_string_equal(one->expectations.rows[i].text, other->expectations.rows[i].text);
        assert_int_equal(one->expectations.rows[i].bad, other->expectations.rows[i].bad);
    }
    assert_int_equal(one->errors.count, other->errors.count);
    assert_memory_equal(one->wafers, other->wafers, one->wafer_count * sizeof *one->wafers);
    assert_int_equal(wh_relations_size(&one->relations), wh_relations_size(&other->relations));
    for (size_t i = 0; i < wh_relations_size(&one->relations); ++i) {
        assert_true(*wh_relations_number(&one->relations, i) == *wh_relations_number(&other->relations, i));
    }
    assert_int_equal(one->worst_count, other->worst_count);
    for (size_t i = 0; i < one->worst_count; ++i) {
        assert_int_equal(one->worst[i].trial, other->worst[i].trial);
        assert_true(one->worst[i].off >= other->worst[i].off && one->worst[i].off <= other->worst[i].off);
    }
}

static void play(wh_worker_t *worker, uint64_t trial, wh_tally_t *tally) {
    char message[WH_SANDBOX_MESSAGE_BYTES];
    const size_t wafer_count = tally->wafer_count;
    wh_tally_free(tally);
    wh_tally_init(tally, wafer_count);
    assert_true(wh_worker_play(worker, trial, tally, message));
}

/* Plays a trial as the study does, and once more with a reason to run the script whole. */
static void compare_trial(wh_worker_t *worker, wh_study_t *study, comparison_t *comparison, uint64_t trial) {
    const char *whole = study->whole;
    study->whole = "to compare with";
    play(worker, trial, &comparison->whole);
    assert_true(worker->outcome.whole);
    study->whole = whole;
    play(worker, trial, &comparison->replayed);
    if (!worker->outcome.whole) {
        assert_int_equal(wh_simulator_hash(&worker->simulator), worker->hash);
        compare_tallies(&comparison->replayed, &comparison->whole);
        ++comparison->replays;
        comparison->pushed += worker->outcome.events[WH_EVENT_PUSHED_THROUGH];
    }
}

/* Except for three trials, at least the share `least` and at most the share `most` of the trials are replayed.
 * Returns how many wafers were pushed through their slots in them. */
static uint64_t compare(const char *script, const char *const parameters[], size_t parameter_count,
                        double least, double most) {
    static wh_study_t study;
    static wh_worker_t worker;
    comparison_t comparison = {.replays = 0};
    memset(&study, 0, sizeof study);
    study.run = (wh_script_run_options_t){
        .script = script, .parameters = parameters, .parameter_count = parameter_count};
    study.run.limits.print_to = stderr;
    study.seed = 5;
    study.trials = TRIALS;
    assert_true(wh_study_open(&study));
    wh_worker_open(&worker, &study);
    wh_tally_init(&comparison.replayed, study.wafer_count);
    wh_tally_init(&comparison.whole, study.wafer_count);
    wh_rounds_t rounds = WH_ROUNDS(LEAST, TRIALS, 0.12);
    while (wh_round(&rounds)) {
        compare_trial(&worker, &study, &comparison, (uint64_t)rounds.number);
    }
    const double replays = (double)comparison.replays;
    const double few = most > 0 ? 3 : 0;
    assert_true(replays >= least * rounds.made - few && replays <= most * rounds.made + few &&
                replays <= rounds.made);
    wh_tally_free(&comparison.replayed);
    wh_tally_free(&comparison.whole);
    wh_worker_close(&worker);
    wh_study_close(&study);
    return comparison.pushed;
}

#define RETRY "tests/end_to_end/data/study_retry.lua"
#define SHELVES "tests/end_to_end/data/study_shelves.lua"

static void picks_and_handovers(void **state) {
    (void)state;
    (void)compare(RETRY, NULL, 0, 19 / 30., 29 / 30.);
}

static void between_slices(void **state) {
    (void)state;
    static const char *const parameters[] = {"check=swept", "seat=true"};
    (void)compare(RETRY, parameters, 2, 19 / 30., 29 / 30.);
}

/* A shelf that is higher than it was taught: the slices in which a wafer goes through it are jumped as well, and what is let go
 * too high is told. */
static void wafers_through_shelves(void **state) {
    (void)state;
    static const char *const swept[] = {"check=swept", "seat=true", "settle=true", "z=1"};
    static const char *const delayed[] = {"check=swept", "seat=true", "vacuum=delayed", "z=1"};
    assert_true(compare(SHELVES, swept, 4, 0.5, 1) > 5);
    assert_true(compare(SHELVES, delayed, 4, 0.5, 1) > 5);
}

/* The lower wafer of a double goes up through the upper one, if that does not lie too far aside to be met. */
static void doubles(void **state) {
    (void)state;
    static const char *const parameters[] = {"double=true", "z=0.01"};
    assert_true(compare(SHELVES, parameters, 2, 0.5, 1) > 5);
}

static void delayed_vacuum(void **state) {
    (void)state;
    static const char *const parameters[] = {"vacuum=delayed", "settle=true"};
    (void)compare(RETRY, parameters, 2, 19 / 30., 29 / 30.);
}

/* While motion control waits for a sensor its slices shift: most trials cannot be replayed, and run whole. */
static void late_valves_and_vacuum(void **state) {
    (void)state;
    static const char *const parameters[] = {"valve=0.002", "late=0.01", "z=0.3"};
    (void)compare(RETRY, parameters, 3, 0, 0.5);
}

static void an_example(void **state) {
    (void)state;
    (void)compare("lua/examples/07_study.lua", NULL, 0, 14 / 15., 1);
}

static void a_script_that_measures_is_never_replayed(void **state) {
    (void)state;
    static const char *const parameters[] = {"by=offset", "by=frames"};
    for (size_t i = 0; i < 2; i += WH_TEST_SHARE) {
        (void)compare(RETRY, &parameters[i], 1, 0, 0);
    }
}

static void collisions_are_never_replayed(void **state) {
    (void)state;
    static const char *const parameters[] = {"collision=true"};
    static wh_study_t study;
    memset(&study, 0, sizeof study);
    study.run = (wh_script_run_options_t){.script = RETRY, .parameters = parameters, .parameter_count = 1};
    assert_true(wh_study_open(&study));
    assert_non_null(study.whole);
    wh_study_close(&study);
}

/* --------------------------------------------------------------------------------- tasks, and a slow model
 *
 * Random scripts with tasks, compared with a model of lua/manual/tasks.md, "Several things at once", slice
 * by slice over plain lists. Both must agree on the first and last slice of each command and wait,
 * on each error, and on how the run ends. */

enum { SCRIPTS = 400, OPS = 6, TASKS = 7, KEPT = 80, SIGNALS = 2, NO_STOP = INT32_MAX };

/* The model's arm, chucks and edge sensors' controller, as bits. */
enum { ARM = 1, P = 2, Q = 4, A = 8, SENSORS = 16 };

/* The steps of a task, one after the other. `play` to `bad_put` are commands. */
typedef enum {
    LINE,
    TURN_P,
    TURN_Q,
    SCAN_P,
    SCAN_Q,
    VALVE_P,
    VALVE_ARM,
    WAIT,
    BAD_GET,
    BAD_PUT,
    MAKE,
    JOIN,
    SIGNAL,
    AWAIT,
    STOP_IN
} kind_t;

/* In Lua a number stands between `before` and `after`, if there is an `after`. */
static const struct {
    const char *before, *after, *text;
    int needs;
    int32_t slices; /* 0: it fails at once with NO_SUCH_SLOT; WH_NONE: as many as it reports */
} commands[] = {
    [LINE] = {"line({ dz = ", " })", "LINE", ARM, 117},
    [TURN_P] = {"rotate(\"P\", 3 * ", ")", "ROTATE P", P, 186},
    [TURN_Q] = {"rotate(\"Q\", 3 * ", ")", "ROTATE Q", Q, 186},
    [SCAN_P] = {"edge_scan(\"P\")", NULL, "EDGE_SCAN P", P | SENSORS, 1342},
    [SCAN_Q] = {"edge_scan(\"Q\")", NULL, "EDGE_SCAN Q", Q | SENSORS, 1342},
    [VALVE_P] = {"valve(\"P1\", 1)", NULL, "VALVE P1", P, 1},
    [VALVE_ARM] = {"valve(\"EE\", 1)", NULL, "VALVE EE", ARM, 1},
    [WAIT] = {"wait(", " / 1000)", "WAIT", 0, WH_NONE},
    [BAD_GET] = {"get(\"A\", 99)", NULL, "GET A 99", ARM | A, 0},
    [BAD_PUT] = {"put(\"P\", 99)", NULL, "PUT P 99", ARM | P, 0},
};

/* Whom STOP_IN stops. */
static const struct {
    const char *lua;
    int has;
} stopped[] = {{"nil", 0}, {"nil", 0}, {"\"robot\"", ARM}, {"\"P\"", P}, {"\"Q1\"", Q}};

typedef struct {
    kind_t kind;
    bool is_caught;  /* its error is */
    int32_t n;       /* slices of WAIT, AWAIT (WH_NONE: for ever), STOP_IN; signals; a motion's sign */
    int32_t task[2]; /* the tasks of MAKE and JOIN; the second may be WH_NONE */
    int32_t name;    /* the signal's name; for STOP_IN: the task that it stops */
} op_t;

typedef enum { GOES, WANTS, PLAYS, JOINS, AWAITS, IS_OVER } doing_t;

typedef struct {
    op_t ops[OPS];
    size_t count, at;
    bool is_made, is_taken, is_busy, was_stopped, is_unheard;
    doing_t doing;
    int error;    /* the error with which it ended; 0: none */
    int32_t left; /* the remaining slices of the command that it plays */
    int holds;
    size_t command;
    int32_t since; /* the slice since which it waits; WH_NONE: it does not */
    int32_t number;
} actor_t;

typedef struct {
    size_t actor;
    const char *text;
    int32_t begin, end;
    int error;
} played_t;

typedef struct {
    size_t actor;
    int32_t begin, end;
} waited_t;

static struct {
    actor_t actors[TASKS];       /* the script first */
    size_t order[TASKS], made;   /* the order in which they were made */
    size_t queue[TASKS], queued; /* the tasks that wait for a resource */
    size_t waiters[SIGNALS][TASKS], waiting[SIGNALS];
    int32_t signals[SIGNALS];
    int32_t slice, stop;
    int whom; /* the task that the STOP stops: its owner; 0: all */
    played_t played[KEPT];
    waited_t waited[KEPT];
    size_t played_count, waited_count;
    bool has_tasks, has_failed;
} model;

static void begin_wait(size_t i) {
    model.actors[i].since = (int32_t)model.waited_count;
    model.waited[model.waited_count++] = (waited_t){i, model.slice, model.slice};
    assert_true(model.waited_count < KEPT);
}

static void end_wait(size_t i) {
    actor_t *actor = &model.actors[i];
    if (actor->since != WH_NONE) {
        model.waited[actor->since].end = model.slice;
        actor->since = WH_NONE;
    }
}

static void leave(size_t list[], size_t *count, size_t who) {
    size_t kept = 0;
    for (size_t i = 0; i < *count; ++i) {
        if (list[i] != who) {
            list[kept++] = list[i];
        }
    }
    *count = kept;
}

static const op_t *op_of(const actor_t *actor) {
    return &actor->ops[actor->at];
}

/* A task that has what this one wants, or wanted it before; WH_NONE: none. */
static int32_t who_has(size_t i) {
    const int needs = commands[op_of(&model.actors[i])->kind].needs;
    for (size_t other = 0; other < TASKS; ++other) {
        if ((model.actors[other].holds & needs) != 0) {
            return (int32_t)other;
        }
    }
    for (size_t k = 0; k < model.queued && model.queue[k] != i; ++k) {
        if ((commands[op_of(&model.actors[model.queue[k]])->kind].needs & needs) != 0) {
            return (int32_t)model.queue[k];
        }
    }
    return WH_NONE;
}

static bool are_over(const op_t *op) {
    bool over = true;
    for (size_t k = 0; k < 2; ++k) {
        over = over && (op->task[k] == WH_NONE || model.actors[op->task[k]].doing == IS_OVER);
    }
    return over;
}

static bool can_go_on(size_t i) {
    const actor_t *actor = &model.actors[i];
    switch (actor->doing) {
    case GOES:
        return true;
    case WANTS:
        return actor->was_stopped || who_has(i) == WH_NONE;
    case PLAYS:
        return !actor->is_busy;
    case JOINS:
        return are_over(op_of(actor));
    case AWAITS:
        return actor->is_taken || (op_of(actor)->n != WH_NONE && !actor->is_busy);
    case IS_OVER:
        break;
    }
    return false;
}

/* True if `from` waits, through other tasks, for `who`. */
static bool waits_for(size_t from, size_t who, bool seen[TASKS]) {
    const actor_t *actor = &model.actors[from];
    bool found = false;
    for (size_t k = 0; k < 2 && actor->doing == JOINS; ++k) {
        const int32_t other = op_of(actor)->task[k];
        if (other == (int32_t)who) {
            return true;
        }
        if (other != WH_NONE && !seen[other] && model.actors[other].doing != IS_OVER) {
            seen[other] = true;
            found = found || waits_for((size_t)other, who, seen);
        }
    }
    return found;
}

static void finish_command(actor_t *actor, int error) {
    model.played[actor->command].end = model.slice;
    model.played[actor->command].error = error;
    actor->holds = 0;
}

/* The task's command has ended. After an error the task has ended too, unless it catches the error. */
static void conclude(size_t i, int error) {
    actor_t *actor = &model.actors[i];
    const bool is_caught = op_of(actor)->is_caught;
    actor->doing = GOES;
    ++actor->at;
    if (error != 0 && !is_caught) {
        actor->doing = IS_OVER;
        actor->error = error;
        actor->is_unheard = true;
    } else if (actor->at == actor->count) {
        actor->doing = IS_OVER;
    }
}

static void begin_play(size_t i, int32_t slices) {
    model.actors[i].is_busy = true;
    model.actors[i].was_stopped = false;
    model.actors[i].left = slices;
}

/* It has received what it wanted, or a STOP came first. */
static void get_going(size_t i) {
    actor_t *actor = &model.actors[i];
    const op_t *op = op_of(actor);
    end_wait(i);
    leave(model.queue, &model.queued, i);
    if (actor->was_stopped) {
        finish_command(actor, WH_STATUS_STOPPED);
        conclude(i, WH_STATUS_STOPPED);
        return;
    }
    actor->holds = commands[op->kind].needs;
    if (commands[op->kind].slices == 0) {
        finish_command(actor, WH_STATUS_NO_SUCH_SLOT);
        conclude(i, WH_STATUS_NO_SUCH_SLOT);
        return;
    }
    begin_play(i, commands[op->kind].slices == WH_NONE ? op->n : commands[op->kind].slices);
    actor->doing = PLAYS;
}

static void begin_command(size_t i) {
    actor_t *actor = &model.actors[i];
    actor->command = model.played_count++;
    assert_true(model.played_count < KEPT);
    model.played[actor->command] =
        (played_t){i, commands[op_of(actor)->kind].text, model.slice, model.slice, 0};
    model.queue[model.queued++] = i;
    actor->was_stopped = false;
    actor->doing = WANTS;
    if (who_has(i) == WH_NONE) {
        get_going(i);
    } else {
        begin_wait(i);
    }
}

/* The first error of the tasks that it joined. */
static void end_join(size_t i) {
    const op_t *op = op_of(&model.actors[i]);
    int error = 0;
    end_wait(i);
    for (size_t k = 0; k < 2 && error == 0; ++k) {
        if (op->task[k] != WH_NONE && model.actors[op->task[k]].error != 0) {
            error = model.actors[op->task[k]].error;
            model.actors[op->task[k]].is_unheard = false;
        }
    }
    conclude(i, error);
}

static void begin_join(size_t i) {
    actor_t *actor = &model.actors[i];
    const op_t *op = op_of(actor);
    bool seen[TASKS] = {false};
    for (size_t k = 0; k < 2; ++k) {
        if (op->task[k] != WH_NONE && (op->task[k] == (int32_t)i || !model.actors[op->task[k]].is_made)) {
            conclude(i, WH_STATUS_BAD_ARGUMENT);
            return;
        }
    }
    actor->doing = JOINS;
    if (waits_for(i, i, seen)) {
        conclude(i, WH_STATUS_DEADLOCK);
    } else if (are_over(op)) {
        end_join(i);
    } else {
        begin_wait(i);
    }
}

static void hand_out(int32_t name) {
    while (model.waiting[name] > 0 && model.signals[name] > 0) {
        const size_t who = model.waiters[name][0];
        leave(model.waiters[name], &model.waiting[name], who);
        model.actors[who].is_taken = true;
        --model.signals[name];
    }
}

static void end_await(size_t i) {
    actor_t *actor = &model.actors[i];
    const op_t *op = op_of(actor);
    end_wait(i);
    leave(model.waiters[op->name], &model.waiting[op->name], i);
    const bool is_stopped = !actor->is_taken && actor->was_stopped;
    actor->is_busy = false;
    conclude(i, is_stopped ? WH_STATUS_STOPPED : 0);
}

static void begin_await(size_t i) {
    actor_t *actor = &model.actors[i];
    const op_t *op = op_of(actor);
    actor->is_taken = false;
    actor->was_stopped = false;
    actor->doing = AWAITS;
    model.waiters[op->name][model.waiting[op->name]++] = i;
    hand_out(op->name);
    if (actor->is_taken) {
        conclude(i, 0);
        return;
    }
    if (op->n != WH_NONE) {
        model.has_tasks = true;
        begin_play(i, op->n);
    }
    begin_wait(i);
}

/* Begins the next step of the task. */
static void begin_op(size_t i) {
    actor_t *actor = &model.actors[i];
    const op_t *op = op_of(actor);
    if (op->kind < MAKE) {
        begin_command(i);
    } else if (op->kind == JOIN) {
        begin_join(i);
    } else if (op->kind == AWAIT) {
        begin_await(i);
    } else {
        if (op->kind == MAKE) {
            model.actors[op->task[0]].is_made = model.has_tasks = true;
            model.order[model.made++] = (size_t)op->task[0];
            model.actors[op->task[0]].number = (int32_t)model.made;
        } else if (op->kind == SIGNAL) {
            model.signals[op->name] += op->n;
            hand_out(op->name);
        } else {
            model.whom = stopped[op->name].has;
            model.has_tasks = model.has_tasks || model.whom != 0;
            model.stop = model.slice + (int32_t)ceil(op->n / 1000.0 * 1e6 / 1000);
        }
        conclude(i, 0);
    }
}

/* It runs until it waits or is over. */
static void go_on(size_t i) {
    actor_t *actor = &model.actors[i];
    do {
        const int error = actor->was_stopped ? WH_STATUS_STOPPED : 0;
        switch ((int)actor->doing) {
        case GOES:
            begin_op(i);
            break;
        case WANTS:
            get_going(i);
            break;
        case PLAYS:
            finish_command(actor, error);
            conclude(i, error);
            break;
        case JOINS:
            end_join(i);
            break;
        default:
            end_await(i);
            break;
        }
    } while (actor->doing == GOES);
}

static bool is_any_busy(void) {
    bool busy = false;
    for (size_t i = 0; i < TASKS; ++i) {
        busy = busy || model.actors[i].is_busy;
    }
    return busy;
}

/* Plays a slice. True if none is played, since a task's command is over. */
static bool play_slice(void) {
    bool is_any_over = false;
    for (size_t i = 0; i < TASKS; ++i) {
        actor_t *actor = &model.actors[i];
        is_any_over = is_any_over || (actor->is_busy && actor->left == 0);
        actor->is_busy = actor->is_busy && actor->left > 0;
    }
    for (size_t i = 0; i < TASKS && !is_any_over; ++i) {
        model.actors[i].left -= model.actors[i].is_busy ? 1 : 0;
    }
    model.slice += is_any_over ? 0 : 1;
    return is_any_over;
}

/* The STOP comes. */
static void stop_those_it_stops(void) {
    for (size_t i = 0; i < TASKS; ++i) {
        actor_t *actor = &model.actors[i];
        if (actor->is_busy && (model.whom == 0 || (actor->holds & model.whom) != 0)) {
            actor->was_stopped = true;
            actor->is_busy = false;
        }
        if (actor->doing == WANTS && model.whom == 0) {
            actor->was_stopped = true;
        }
    }
    model.stop = NO_STOP;
}

/* Plays slices until a task's command is over, or a STOP comes. */
static void advance(void) {
    bool is_any_over = false;
    while (!is_any_over && model.slice < model.stop) {
        is_any_over = play_slice();
    }
    if (model.slice >= model.stop) {
        stop_those_it_stops();
    }
}

/* The others go on, each in turn, while the script cannot. False if none can, and nothing moves. */
static bool drive(bool (*is_done)(void)) {
    while (!is_done()) {
        bool went = false;
        for (size_t k = 0; k < model.made && !is_done(); ++k) {
            if (can_go_on(model.order[k])) {
                go_on(model.order[k]);
                went = true;
            }
        }
        if (!went && !is_done()) {
            if (!is_any_busy()) {
                return false;
            }
            advance();
        }
    }
    return true;
}

static bool script_can(void) {
    return can_go_on(0);
}

static bool all_are_over(void) {
    bool over = true;
    for (size_t k = 0; k < model.made; ++k) {
        over = over && model.actors[model.order[k]].doing == IS_OVER;
    }
    return over;
}

/* The script has failed, so the commands of its tasks have failed, too. */
static void stop_all(void) {
    model.has_failed = true;
    for (size_t i = 1; i < TASKS; ++i) {
        if (model.actors[i].doing == WANTS || model.actors[i].doing == PLAYS) {
            finish_command(&model.actors[i], WH_STATUS_STOPPED);
        }
    }
}

/* The script runs until it is over; the tasks run while it waits. */
static void run_script(void) {
    actor_t *script = &model.actors[0];
    while (script->doing != IS_OVER) {
        go_on(0);
        if (script->doing != IS_OVER && !drive(script_can)) {
            end_wait(0);
            for (int32_t name = 0; name < SIGNALS; ++name) {
                leave(model.waiters[name], &model.waiting[name], 0);
            }
            conclude(0, WH_STATUS_DEADLOCK);
        }
    }
}

static void run_model(void) {
    const actor_t *script = &model.actors[0];
    run_script();
    bool is_waiting = false;
    if (script->error == 0 && !all_are_over()) {
        begin_wait(0);
        is_waiting = true;
    }
    if (script->error != 0 || !drive(all_are_over)) {
        stop_all();
    }
    if (is_waiting) {
        end_wait(0);
    }
    for (size_t i = 0; i < TASKS; ++i) {
        end_wait(i);
        model.has_failed = model.has_failed || model.actors[i].is_unheard;
    }
}

/* ------------------------------------------------------------------------------------------ random scripts */

/* Scans are long: two of three are replaced by turns. */
static kind_t random_kind(void) {
    const kind_t kind = (kind_t)wh_test_below(STOP_IN + 1);
    if ((kind == SCAN_P || kind == SCAN_Q) && wh_test_below(3) != 0) {
        return kind == SCAN_P ? TURN_P : TURN_Q;
    }
    return kind;
}

/* The other arguments of a JOIN, a SIGNAL or an AWAIT. */
static void randomize(op_t *op) {
    if (op->kind == JOIN) {
        op->task[0] = 1 + (int32_t)wh_test_below(TASKS - 1);
        op->task[1] = wh_test_below(2) == 0 ? WH_NONE : 1 + (int32_t)wh_test_below(TASKS - 1);
    } else if (op->kind == SIGNAL) {
        op->n = 1 + (int32_t)wh_test_below(2);
    } else if (op->kind == AWAIT) {
        op->n = wh_test_below(3) == 0 ? WH_NONE : (int32_t)wh_test_below(300);
    }
}

static op_t random_op(size_t task, size_t *made) {
    op_t op = {
        .is_caught = wh_test_below(6) > 0, .n = 1 + (int32_t)wh_test_below(300), .task = {WH_NONE, WH_NONE}};
    op.name = (int32_t)wh_test_below(SIGNALS);
    op.kind = random_kind();
    if (op.kind == STOP_IN) {
        op.name = (int32_t)wh_test_below(sizeof stopped / sizeof *stopped);
    }
    if (op.kind == MAKE || (task == 0 && *made < 3)) {
        op.kind = *made + 1 < TASKS ? MAKE : WAIT;
        op.task[0] = op.kind == MAKE ? (int32_t)++ * made : WH_NONE;
    } else {
        randomize(&op);
    }
    return op;
}

static void command_text(char *text, size_t size, const op_t *op) {
    const int sign = op->n % 2 == 0 ? 1 : -1;
    (void)snprintf(text, size, "%s", commands[op->kind].before);
    if (commands[op->kind].after) {
        (void)snprintf(text, size, "%s%d%s", commands[op->kind].before, op->kind == WAIT ? (int)op->n : sign,
                       commands[op->kind].after);
    }
}

static void write_op(FILE *out, const op_t *op) {
    char text[100];
    switch ((int)op->kind) {
    case MAKE:
        (void)snprintf(text, sizeof text, "T[%d] = task(B[%d])", (int)op->task[0], (int)op->task[0]);
        break;
    case JOIN:
        (void)snprintf(text, sizeof text, op->task[1] == WH_NONE ? "join(T[%d])" : "join(T[%d], T[%d])",
                       (int)op->task[0], (int)op->task[1]);
        break;
    case SIGNAL:
        (void)snprintf(text, sizeof text, "signal(\"s%d\", %d)", (int)op->name, (int)op->n);
        break;
    case AWAIT:
        (void)snprintf(text, sizeof text, op->n == WH_NONE ? "await(\"s%d\")" : "await(\"s%d\", %d / 1000)",
                       (int)op->name, (int)op->n);
        break;
    case STOP_IN:
        (void)snprintf(text, sizeof text, "stop_in(%d / 1000, %s)", (int)op->n, stopped[op->name].lua);
        break;
    default:
        command_text(text, sizeof text, op);
        break;
    }
    fprintf(out, op->is_caught ? "  pcall(function() %s end)\n" : "  %s\n", text);
}

/* Draws the model's tasks, and writes them as a script. */
static void write_random_script(const char *path) {
    char here[1000];
    size_t made = 0;
    FILE *out = fopen(path, "w");
    assert_non_null(out);
    assert_non_null(getcwd(here, sizeof here));
    memset(&model, 0, sizeof model);
    model.stop = NO_STOP;
    fprintf(out, "cell \"%s/lua/layouts/two_aligners.lua\"\nlocal B, T = {}, {}\n", here);
    for (size_t i = 0; i < TASKS; ++i) {
        actor_t *actor = &model.actors[i];
        actor->since = WH_NONE;
        actor->count = OPS - wh_test_below(3);
        for (size_t k = 0; k < actor->count; ++k) {
            actor->ops[k] = random_op(i, &made);
        }
    }
    for (size_t i = TASKS; i-- > 0;) {
        fprintf(out, "B[%zu] = function()\n", i);
        for (size_t k = 0; k < model.actors[i].count; ++k) {
            write_op(out, &model.actors[i].ops[k]);
        }
        fputs("end\n", out);
    }
    fputs("B[0]()\n", out);
    assert_int_equal(fclose(out), 0);
}

static int32_t slice_of(double seconds) {
    return (int32_t)(seconds * 1000 + 0.5);
}

static void compare_commands(const wh_record_t *record) {
    assert_int_equal(record->command_count, model.played_count);
    for (size_t i = 0; i < model.played_count; ++i) {
        const wh_command_record_t *command = &record->commands[i];
        const played_t *played = &model.played[i];
        assert_memory_equal(command->text, played->text, strlen(played->text));
        assert_int_equal(slice_of(command->begin_s), played->begin);
        assert_int_equal(slice_of(command->end_s), played->end);
        assert_int_equal(command->error, played->error);
        assert_int_equal(command->task, model.actors[played->actor].number);
    }
}

/* A wait of no slice is not kept. */
static void compare_waits(const wh_record_t *record) {
    size_t kept = 0;
    for (size_t i = 0; i < model.waited_count; ++i) {
        const waited_t *waited = &model.waited[i];
        if (waited->end > waited->begin) {
            assert_true(kept < record->wait_count);
            assert_int_equal(record->waits[kept].begin, waited->begin);
            assert_int_equal(record->waits[kept].end, waited->end);
            assert_int_equal(record->waits[kept].task, model.actors[waited->actor].number);
            ++kept;
        }
    }
    assert_int_equal(record->wait_count, kept);
}

static void tasks_do_what_a_slow_model_does(void **state) {
    (void)state;
    static wh_script_run_t run;
    char path[WH_TEST_PATH];
    const int file = mkstemp(wh_test_path(path, "tasks"));
    FILE *nowhere = fopen("/dev/null", "w");
    assert_true(file >= 0 && nowhere && close(file) == 0);
    size_t failed = 0, waits = 0, deadlocks = 0;
    int64_t left_out = 0;
    wh_rounds_t rounds = WH_ROUNDS(40, SCRIPTS, 0.4);
    while (wh_round(&rounds)) {
        const wh_script_run_options_t options = {
            .script = path, .limits = {.print_to = nowhere}, .counts = (wh_mcs_count_t)(rounds.number % 2)};
        write_random_script(path);
        run_model();
        (void)wh_script_run(&run, &options);
        compare_commands(&run.record);
        if (model.has_tasks) {
            compare_waits(&run.record);
        }
        assert_true((run.record.failure != NULL) == model.has_failed);
        assert_int_equal(run.record.slices, model.slice);
        failed += model.has_failed ? 1 : 0;
        waits += run.record.wait_count;
        left_out += run.record.counted.left_out;
        deadlocks += run.record.failure && strstr(run.record.failure, "DEADLOCK") ? 1 : 0;
        wh_script_run_close(&run);
    }
    printf("%d scripts: %zu failed, %zu of them by a deadlock; %zu waits\n", rounds.made, failed, deadlocks,
           waits);
    assert_true(failed > 0 && deadlocks > 0 && waits > (size_t)rounds.made);
    assert_true(left_out > 100 * rounds.made);
    assert_int_equal(fclose(nowhere), 0);
    assert_int_equal(remove(path), 0);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(picks_and_handovers),
        cmocka_unit_test(between_slices),
        cmocka_unit_test(wafers_through_shelves),
        cmocka_unit_test(delayed_vacuum),
        cmocka_unit_test(doubles),
        cmocka_unit_test(late_valves_and_vacuum),
        cmocka_unit_test(an_example),
        cmocka_unit_test(a_script_that_measures_is_never_replayed),
        cmocka_unit_test(collisions_are_never_replayed),
        cmocka_unit_test(tasks_do_what_a_slow_model_does),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
