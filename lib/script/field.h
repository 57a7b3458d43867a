/* A field that tables of one kind may have: one row a fact.
 *
 * Readers refuse all fields that have no row, `waferhand definitions` writes the rows for editors, and
 * whoever shows, sends or checks a struct walks them. A scalar's row also says where its table's struct
 * has it, what it is without the field, and within which limits it is read. This header has no Lua.
 * Nothing here allocates.
 */
#ifndef WH_SCRIPT_FIELD_H
#define WH_SCRIPT_FIELD_H

#include <math.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* How a struct holds a scalar. */
typedef enum {
    WH_SCALAR_BY_HAND, /* no scalar, or one that has no range of its own */
    WH_SCALAR_APART,   /* a scalar that its reader's own code puts somewhere: range and default alone */
    WH_SCALAR_NUMBER,  /* double: as the table has it */
    WH_SCALAR_DEGREES, /* double: rad, where the table has degrees */
    WH_SCALAR_WHOLE,   /* int32_t */
    WH_SCALAR_SEED,    /* uint64_t */
    WH_SCALAR_SWITCH,  /* bool */
    WH_SCALAR_WORD     /* an enumeration: the word's index */
} wh_scalar_kind_t;

/* A default that follows from other fields, which the reader's code gives; and the value that the struct
 * has before it is read. */
#define WH_FIELD_FOLLOWS ((double)NAN)
#define WH_FIELD_KEPT ((double)INFINITY)

typedef struct {
    const char *name; /* null ends a list */
    const char *type; /* in the Lua language server's notation, such as number or "a"|"b" */
    const char *text; /* its description, which begins with its unit */
    bool required;
    /* For a scalar; else all zero: */
    wh_scalar_kind_t kind;
    size_t offset;            /* in the table's struct */
    double least, most;       /* a number's range, in the table's unit */
    double usual;             /* its default: a number, 0 or 1, a word's index, or one of the two above */
    const char *const *words; /* up to a null, in the order of the enumeration */
    /* For people: its default in words, where `usual` is no value. Null: there is none. */
    const char *otherwise;
    int hashed; /* the part of the layout's hash in which it is; 0: in none that goes by rows */
} wh_reader_field_t;

/* Its type, which an enumeration has from its words: "\"up\"|\"down\"". Cut to fit. */
void wh_field_type(const wh_reader_field_t *row, char *type, size_t size);

/* The row of this name; null: there is none. */
const wh_reader_field_t *wh_field_find(const wh_reader_field_t *rows, const char *name);

/* True for a scalar that its table's struct has. */
bool wh_field_is_member(const wh_reader_field_t *row);

/* A member, in the table's unit: a switch as 0 or 1, a word as its index. */
double wh_field_get(const wh_reader_field_t *row, const void *of);

/* Hashes a member as the struct has it: an angle in rad. */
uint64_t wh_field_hash(const wh_reader_field_t *row, const void *of, uint64_t hash);

/* Sets it. The value must be within the row's range. */
void wh_field_set(const wh_reader_field_t *row, double value, void *of);

/* True for a member that is a number in the table, whole or not. */
bool wh_field_is_number(const wh_reader_field_t *row);

/* The unit with which a number's text begins, such as "mm/s"; empty: a count or a part. */
#define WH_FIELD_UNIT_BYTES 16
void wh_field_unit(const wh_reader_field_t *row, char unit[WH_FIELD_UNIT_BYTES]);

#endif
