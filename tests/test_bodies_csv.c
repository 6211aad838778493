#include "check.h"

#include <locale.h>

#include "base/random.h"
#include "base/text.h"
#include "math/vec.h"
#include "sim/bodies_csv.h"

static const dem_shape_def shapes[] = {{.name = "rock"}, {.name = "big, \"old\" rock"}, {.name = "a"}};
enum { SHAPES = 3 };

typedef struct table {
    dem_body_def *bodies;
    size_t count, capacity;
} table;

static dem_status parsed(const char *text, table *t, dem_error *error)
{
    *t = (table){0};
    return dem_bodies_csv_parse(text, strlen(text), "b.csv", shapes, SHAPES, &t->bodies, &t->count, &t->capacity,
                                error);
}

static table table_of(const char *text)
{
    table t;
    dem_error error;
    check_ok(parsed(text, &t, &error), error);
    return t;
}

static void columns_are_found_by_their_names(void **state)
{
    (void)state;
    table t = table_of("id,wz,z,shape,y,x,vx,vy,vz,wx,wy,scale,qw,qx,qy,qz,mass,coordination\n"
                       "7,-3,3,a,2,1,4,5,6,-1,-2,0.5,0.6,0,0.8,0,1e9,nan\n"
                       "8,0,0,rock,0,0,0,0,0,0,0,1,2,0,0,0,,\n");
    check(t.count == 2);
    const dem_body_def *b = t.bodies;
    check(b[0].shape == 2 && b[0].scale == 0.5);
    check_vec(b[0].position, v3(1, 2, 3), 0);
    check_vec(b[0].velocity, v3(4, 5, 6), 0);
    check_vec(b[0].spin, v3(-1, -2, -3), 0);
    check(b[0].orientation.w == 0.6 && b[0].orientation.y == 0.8);
    check(b[1].shape == 0 && b[1].orientation.w == 1);
    free(t.bodies);
}

static void what_is_left_out_has_its_default(void **state)
{
    (void)state;
    table t = table_of("shape,x,y,z\nrock,1,2,3");
    check(t.count == 1 && t.bodies->scale == 1 && t.bodies->orientation.w == 1 && t.bodies->orientation.x == 0);
    check_vec(t.bodies->velocity, v3(0, 0, 0), 0);
    check_vec(t.bodies->spin, v3(0, 0, 0), 0);
    free(t.bodies);
}

static void lines_may_end_and_begin_as_editors_like(void **state)
{
    (void)state;
    table t = table_of("\xef\xbb\xbf# made by hand\r\n\r\nshape , x,y ,\"z\"\r\n  rock, 1 ,\t2, 3 \r\n   \n"
                       "# a, comment\n\"big, \"\"old\"\" rock\",-1,+2,1e-3\r\n\"a\" ,0,0,0\n\n");
    check(t.count == 3 && t.bodies[0].shape == 0 && t.bodies[1].shape == 1 && t.bodies[2].shape == 2);
    check_vec(t.bodies[0].position, v3(1, 2, 3), 0);
    check_vec(t.bodies[1].position, v3(-1, 2, 1e-3), 0);
    free(t.bodies);
    t = table_of("shape,x,y,z");
    check(t.count == 0);
    free(t.bodies);
}

static void a_second_file_is_appended(void **state)
{
    (void)state;
    table t = table_of("shape,x,y,z\nrock,1,2,3\n");
    dem_error error;
    const char *more = "shape,x,y,z\na,4,5,6\n";
    check_ok(
        dem_bodies_csv_parse(more, strlen(more), "c.csv", shapes, SHAPES, &t.bodies, &t.count, &t.capacity, &error),
        error);
    check(t.count == 2 && t.bodies[0].shape == 0 && t.bodies[1].shape == 2);
    free(t.bodies);
}

static void quaternions_are_made_unit_ones(void **state)
{
    (void)state;
    table t =
        table_of("shape,x,y,z,qw,qx,qy,qz\nrock,0,0,0,1,2,3,4\nrock,0,0,0,1e90,0,0,1e90\nrock,0,0,0,1e-300,0,0,0\n");
    check_near(t.bodies[0].orientation.z, 4 / sqrt(30), 1e-15);
    check_near(t.bodies[1].orientation.w, sqrt(0.5), 1e-15);
    check_near(t.bodies[2].orientation.w, 1, 0);
    free(t.bodies);
    // one that is a unit quaternion keeps its bits
    dem_random r = random_stream(1, 0);
    for (int i = 0; i < 1000; i++) {
        dem_quat q = {random_normal(&r), random_normal(&r), random_normal(&r), random_normal(&r)}, again;
        check(dem_quat_normalise(&q));
        again = q;
        check(dem_quat_normalise(&again));
        assert_memory_equal(&q, &again, sizeof q);
        check_near(q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z, 1, 2e-15);
    }
}

static void a_wrong_line_is_refused_by_line_and_column(void **state)
{
    (void)state;
    static const struct {
        const char *text;
        long line;
        const char *message;
    } cases[] = {
        {"", 0, "has no line of column names"},
        {"# only\n\n", 2, "has no line of column names"},
        {"shape,x,y\n", 1, "column \"z\" is missing; add it"},
        {"x,y,z\n", 1, "column \"shape\" is missing"},
        {"shape,x,y,z,qw,qx,qz\n", 1, "column \"qy\" is missing"},
        {"shape,x,y,z,x\n", 1, "column \"x\" stands twice"},
        {"shape,x,y,z,scael\n", 1, "unknown column \"scael\"; did you mean \"scale\"?"},
        {"shape,x,y,z,colour\n", 1, "unknown column \"colour\"; columns are"},
        {"shape,x,y,z,\n", 1, "unknown column \"\""},
        {"shape;x;y;z\n", 1, "unknown column \"shape;x;y;z\""},
        {"\"shape,x,y,z\n", 1, "is not closed"},
        {"\"shape\" x,y,z\n", 1, "a comma is missing"},
        {"shape,x,y,z\n\n# c\nrock,1,2\n", 4, "column \"z\" is missing, the line has 3 of 4; complete it"},
        {"shape,x,y,z\nrock,1,2,3,4\n", 2, "has more columns than the first line"},
        {"shape,x,y,z\nrock,1,abc,3\n", 2, "column \"y\": \"abc\" is not a finite number"},
        {"shape,x,y,z\nrock,1,1 mm,3\n", 2, "column \"y\": \"1 mm\" is not a finite number"},
        {"shape,x,y,z\nrock,1,,3\n", 2, "column \"y\": \"\" is not a finite number"},
        {"shape,x,y,z\nrock,nan,2,3\n", 2, "column \"x\": \"nan\""},
        {"shape,x,y,z\nrock,1,2,inf\n", 2, "column \"z\": \"inf\""},
        {"shape,x,y,z\nrock,1,2,1e101\n", 2, "column \"z\": \"1e101\""},
        {"shape,x,y,z\nrock,\"1\",2,1\n", 2, "column \"x\""},
        {"shape,x,y,z\nrok,1,2,3\n", 2, "column \"shape\": the scene has no shape \"rok\"; did you mean \"rock\"?"},
        {"shape,x,y,z\nsomething else,1,2,3\n", 2, "the scene has no shape \"something else\"; add it to shapes"},
        {"shape,x,y,z\n\"rock,1,2,3\n", 2, "is not closed"},
        {"shape,x,y,z\n\"rock\"1,2,3,4\n", 2, "column \"x\" is missing"},
        {"shape,x,y,z,scale\nrock,1,2,3,0\n", 2, "column \"scale\": must be above 0"},
        {"shape,x,y,z,scale\nrock,1,2,3,-1\n", 2, "column \"scale\": must be above 0"},
        {"shape,x,y,z,qw,qx,qy,qz\nrock,1,2,3,0,0,0,0\n", 2, "columns \"qw\" to \"qz\""},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        table t;
        dem_error error = {0};
        dem_status status = parsed(cases[i].text, &t, &error);
        if (status != DEM_BAD_INPUT || error.line != cases[i].line || !strstr(error.text, cases[i].message))
            print_error("%s\n%d :%ld: %s\n", cases[i].text, status, error.line, error.text);
        check(status == DEM_BAD_INPUT && error.line == cases[i].line && strstr(error.text, cases[i].message));
        check(strchr(error.text, ';') != NULL);
        assert_string_equal(error.file, "b.csv");
        free(t.bodies);
        check(parsed(cases[i].text, &t, NULL) == DEM_BAD_INPUT);
        free(t.bodies);
    }
}

// numbers of 17 digits come back in every bit, whatever the locale
static void a_written_state_is_read_without_loss(void **state)
{
    (void)state;
    enum { COUNT = 20000 };
    dem_random r = random_stream(9, 0);
    dem_buffer out = {0};
    double *numbers = malloc(COUNT * 6 * sizeof *numbers);
    dem_buffer_text(&out, "shape,x,y,z,vx,vy,vz\n");
    for (size_t i = 0; i < (size_t)COUNT * 6; i++) {
        numbers[i] = random_normal(&r) * pow(10, (double)random_below(&r, 40) - 20);
        dem_buffer_text(&out, i % 6 ? "," : "rock,");
        dem_buffer_number(&out, numbers[i], 17);
        if (i % 6 == 5)
            dem_buffer_text(&out, "\n");
    }
    bool german = setlocale(LC_ALL, "de_DE.UTF-8") != NULL;
    table t;
    dem_error error;
    dem_status status = parsed(out.data, &t, &error);
    if (german)
        setlocale(LC_ALL, "C");
    check_ok(status, error);
    check(t.count == COUNT);
    for (size_t i = 0; i < COUNT; i++) {
        assert_memory_equal(&t.bodies[i].position, &numbers[6 * i], sizeof(dem_vec3));
        assert_memory_equal(&t.bodies[i].velocity, &numbers[6 * i + 3], sizeof(dem_vec3));
    }
    free(t.bodies);
    free(numbers);
    dem_buffer_release(&out);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(columns_are_found_by_their_names),
        cmocka_unit_test(what_is_left_out_has_its_default),
        cmocka_unit_test(lines_may_end_and_begin_as_editors_like),
        cmocka_unit_test(a_second_file_is_appended),
        cmocka_unit_test(quaternions_are_made_unit_ones),
        cmocka_unit_test(a_wrong_line_is_refused_by_line_and_column),
        cmocka_unit_test(a_written_state_is_read_without_loss),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
