#include "folder.h"
#include "views.h"

#include "out/final.h"

static void write_final(const char *directory, const dem_body_view *bodies, int threads)
{
    dem_ctx ctx = {.threads = threads};
    dem_error error;
    check_ok(dem_final_write(&ctx, directory, VIEW_SHAPE_DEFS, VIEW_SHAPES, bodies, &error), error);
}

// the next `count` numbers behind commas; returns where they end
static const char *read_numbers(const char *at, const char *end, double *numbers, int count)
{
    for (int k = 0; k < count; k++) {
        check(*at == ',');
        at = dem_parse_double(at + 1, end, &numbers[k]);
        check(at != NULL);
    }
    return at;
}

static void the_state_is_read_back_bit_for_bit(void **state)
{
    (void)state;
    made_view v;
    dem_body_view bodies = view_bodies(&v, 5);
    v.position[0] = v3(-0.0, 5e-324, 1.7976931348623157e308);
    write_final(in_folder("deep/state"), &bodies, 1);
    dem_buffer file = content(in_folder("deep/state/final.csv"));
    const char head[] = "shape,x,y,z,qw,qx,qy,qz,vx,vy,vz,wx,wy,wz,scale\n", *end = file.data + file.size;
    assert_memory_equal(file.data, head, strlen(head));
    const char *at = file.data + strlen(head);
    for (int i = 0; i < VIEW_BODIES; i++) {
        const char *name = VIEW_SHAPE_DEFS[v.shape[i]].name;
        check(strncmp(at, name, strlen(name)) == 0);
        double n[14];
        at = read_numbers(at + strlen(name), end, n, 14);
        check(*at++ == '\n');
        assert_memory_equal(n, &v.position[i], 3 * sizeof *n);
        assert_memory_equal(n + 3, &v.orientation[i], 4 * sizeof *n);
        assert_memory_equal(n + 7, &v.velocity[i], 3 * sizeof *n);
        assert_memory_equal(n + 10, &v.spin[i], 3 * sizeof *n);
        check(n[13] == v.scale[i]);
    }
    check(at == end);
    dem_buffer_release(&file);
}

static void the_scale_is_left_out_where_all_are_1(void **state)
{
    (void)state;
    made_view v;
    dem_body_view bodies = view_bodies(&v, 6);
    for (int i = 0; i < VIEW_BODIES; i++)
        v.scale[i] = 1;
    write_final(folder, &bodies, 1);
    dem_buffer file = content(in_folder("final.csv"));
    check(strstr(file.data, ",wz\n") && !strstr(file.data, "scale"));
    double n[13];
    const char *row = strchr(file.data, '\n') + 1, *name = VIEW_SHAPE_DEFS[v.shape[0]].name;
    check(*read_numbers(row + strlen(name), file.data + file.size, n, 13) == '\n');
    dem_buffer_release(&file);
    v.scale[VIEW_BODIES - 1] = 0.5;
    write_final(folder, &bodies, 1);
    file = content(in_folder("final.csv"));
    check(strstr(file.data, ",wz,scale\n") != NULL);
    dem_buffer_release(&file);
    write_final(folder, &(dem_body_view){0}, 1);
    file = content(in_folder("final.csv"));
    assert_string_equal(file.data, "shape,x,y,z,qw,qx,qy,qz,vx,vy,vz,wx,wy,wz\n");
    dem_buffer_release(&file);
}

static void names_with_commas_stand_in_quotes(void **state)
{
    (void)state;
    static const struct {
        const char *name, *field;
    } cases[] = {{"plain-1.5 b", "plain-1.5 b"},
                 {"a,b", "\"a,b\""},
                 {"say \"so\"", "\"say \"\"so\"\"\""},
                 {" x", "\" x\""},
                 {"#1", "\"#1\""},
                 {"", "\"\""}};
    made_view v;
    dem_body_view bodies = view_bodies(&v, 1);
    bodies.count = 1;
    v.shape[0] = 0;
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        dem_shape_def shape = {.name = cases[i].name};
        dem_error error;
        check_ok(dem_final_write(NULL, folder, &shape, 1, &bodies, &error), error);
        dem_buffer file = content(in_folder("final.csv"));
        const char *row = strchr(file.data, '\n') + 1;
        check(strncmp(row, cases[i].field, strlen(cases[i].field)) == 0 && row[strlen(cases[i].field)] == ',');
        dem_buffer_release(&file);
    }
}

// `count` bodies that repeat a small view
static dem_body_view many(const made_view *v, size_t count)
{
    dem_body_view b = {.count = count};
#define REPEAT(field, from)                                                                                            \
    do {                                                                                                               \
        char *to_ = malloc(count * sizeof *v->from);                                                                   \
        check(to_ != NULL);                                                                                            \
        for (size_t i = 0; i < count; i++)                                                                             \
            memcpy(to_ + i * sizeof *v->from, &v->from[i % VIEW_BODIES], sizeof *v->from);                             \
        b.field = (void *)to_;                                                                                         \
    } while (0)
    REPEAT(shape, shape);
    REPEAT(scale, scale);
    REPEAT(position, position);
    REPEAT(orientation, orientation);
    REPEAT(velocity, velocity);
    REPEAT(spin, spin);
#undef REPEAT
    return b;
}

static void release(dem_body_view *b)
{
    free((void *)b->shape);
    free((void *)b->scale);
    free((void *)b->position);
    free((void *)b->orientation);
    free((void *)b->velocity);
    free((void *)b->spin);
}

static void rows_stand_in_order_for_any_number_of_threads(void **state)
{
    (void)state;
    enum { COUNT = 3 * 4096 + 5 };  // several blocks, the last one not full
    made_view v;
    view_bodies(&v, 9);
    dem_body_view b = many(&v, COUNT);
    write_final(in_folder("one"), &b, 1);
    write_final(in_folder("three"), &b, 3);
    check_same_file(in_folder("one/final.csv"), in_folder("three/final.csv"));
    dem_buffer file = content(in_folder("one/final.csv"));
    size_t rows = 0, first = 0;
    for (const char *p = file.data; (p = strchr(p, '\n')); p++)
        if (rows++ == VIEW_BODIES)
            first = (size_t)(p - strchr(file.data, '\n'));  // bytes of the view's rows
    check(rows == COUNT + 1);
    const char *body = strchr(file.data, '\n') + 1;
    check(memcmp(body, body + first, file.size - (size_t)(body - file.data) - first) == 0);
    dem_buffer_release(&file);
    release(&b);
}

static void a_folder_that_cannot_be_is_said(void **state)
{
    (void)state;
    dem_error error;
    check_ok(dem_file_write(in_folder("file"), "x", 1, &error), error);
    check(dem_final_write(NULL, in_folder("file"), NULL, 0, &(dem_body_view){0}, &error) == DEM_CANNOT_WRITE);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_state_is_read_back_bit_for_bit),
        cmocka_unit_test(the_scale_is_left_out_where_all_are_1),
        cmocka_unit_test(names_with_commas_stand_in_quotes),
        cmocka_unit_test(rows_stand_in_order_for_any_number_of_threads),
        cmocka_unit_test(a_folder_that_cannot_be_is_said),
    };
    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
