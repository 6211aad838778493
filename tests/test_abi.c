// The table of structures tells each of them whole, so that a binding made from it fits.
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <string.h>

#include <cmocka.h>

#include "dem/dem.h"

static const dem_abi_row *whole_of(const char *type)
{
    size_t count;
    const dem_abi_row *rows = dem_abi(&count);
    for (size_t i = 0; i < count; i++)
        if (strcmp(rows[i].type, type) == 0 && !rows[i].field[0])
            return &rows[i];
    return NULL;
}

// bytes of one element; 0: not known
static size_t size_of(const char *kind)
{
    static const struct {
        const char *kind;
        size_t size;
    } plain[] = {{"bool", 1}, {"char", 1}, {"i32", 4}, {"u32", 4},
                 {"i64", 8},  {"u64", 8},  {"f64", 8}, {"pointer", sizeof(void *)}};
    for (size_t i = 0; i < sizeof plain / sizeof *plain; i++)
        if (strcmp(kind, plain[i].kind) == 0)
            return plain[i].size;
    const dem_abi_row *whole = whole_of(kind);
    return whole ? whole->size : 0;
}

static void fields_cover_their_structure(void **state)
{
    (void)state;
    size_t count, structures = 0;
    const dem_abi_row *rows = dem_abi(&count);
    for (size_t i = 0; i < count;) {
        const dem_abi_row *whole = &rows[i++];
        assert_string_equal(whole->field, "");
        size_t end = 0;
        structures++;
        for (; i < count && rows[i].field[0]; i++) {
            const dem_abi_row *row = &rows[i];
            assert_string_equal(row->type, whole->type);
            size_t element = size_of(row->kind);
            if (!element || row->size % element)
                fail_msg("%s.%s: kind %s does not fit in %zu bytes", row->type, row->field, row->kind, row->size);
            if (row->size / element > 1 && strcmp(row->kind, "pointer") == 0)
                fail_msg("%s.%s: an array of pointers, or a kind the table does not know", row->type, row->field);
            // a missing field of eight bytes or more shows as a gap
            if (row->offset < end || row->offset - end >= 8)
                fail_msg("%s: %zd bytes before %s are no field of lib/out/abi.c", row->type,
                         (ptrdiff_t)(row->offset - end), row->field);
            end = row->offset + row->size;
        }
        if (end && (end > whole->size || whole->size - end >= 8))
            fail_msg("%s: %zd bytes behind the last are no field of lib/out/abi.c", whole->type,
                     (ptrdiff_t)(whole->size - end));
    }
    assert_true(structures > 20);
}

static void the_table_tells_what_the_compiler_did(void **state)
{
    (void)state;
    assert_int_equal(whole_of("dem_clump_def")->size, sizeof(dem_clump_def));
    assert_int_equal(whole_of("dem_scene")->size, sizeof(dem_scene));
    size_t count, seen = 0;
    const dem_abi_row *rows = dem_abi(&count);
    for (size_t i = 0; i < count; i++)
        if (strcmp(rows[i].type, "dem_clump_def") == 0 && strcmp(rows[i].field, "union_inertia") == 0) {
            assert_int_equal(rows[i].offset, offsetof(dem_clump_def, union_inertia));
            assert_int_equal(rows[i].size, 3 * sizeof(double));
            assert_string_equal(rows[i].kind, "f64");
            seen++;
        }
    assert_int_equal(seen, 1);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(fields_cover_their_structure),
        cmocka_unit_test(the_table_tells_what_the_compiler_did),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
