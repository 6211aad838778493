#include "views.h"

#include "out/field.h"

static const double DIAMETERS[VIEW_SHAPES] = {1, 2, 3};

static dem_field_source source_of(const dem_body_view *bodies, const dem_vtp *frame)
{
    return (dem_field_source){.bodies = bodies, .diameters = DIAMETERS, .up = {0, 0, -1}, .frame = frame};
}

static void check_field(const char *name, const dem_field_source *s, size_t body, double want, const char *unit)
{
    dem_field f;
    dem_error error;
    check_ok(dem_field_make(name, s, &f, &error), error);
    check_near(f.values[body], want, 1e-15 * fabs(want));
    assert_string_equal(f.unit, unit);
    free(f.values);
}

static void what_is_always_known_has_its_unit(void **state)
{
    (void)state;
    made_view v;
    dem_body_view bodies = view_bodies(&v, 3);
    dem_field_source s = source_of(&bodies, NULL);
    check_field("size", &s, 2, v.scale[2] * DIAMETERS[v.shape[2]], "m");
    check_field("speed", &s, 3, v3_norm(v.velocity[3]), "m/s");
    check_field("spin", &s, 1, v3_norm(v.spin[1]), "rad/s");
    check_field("coordination", &s, 4, v.coordination[4], "");
    check_field("height", &s, 5, -v.position[5].z, "m");
    check_field("mass", &s, 6, v.mass[6], "kg");
    check_field("y", &s, 0, v.position[0].y, "m");
    for (dem_picture_colour c = DEM_PICTURE_SIZE; c <= DEM_PICTURE_HEIGHT; c++)
        check(dem_field_of_colour(c) != NULL);
    check(!dem_field_of_colour(DEM_PICTURE_NUMBER) && !dem_field_of_colour(DEM_PICTURE_VALUES));
}

static void arrays_of_a_frame_are_taken_by_component(void **state)
{
    (void)state;
    made_view v;
    dem_body_view bodies = view_bodies(&v, 3);
    const dem_vtp_array arrays[] = {{"velocity", DEM_VTP_FLOAT64, 3, v.velocity},
                                    {"turn", DEM_VTP_FLOAT64, 4, v.orientation},
                                    {"template", DEM_VTP_UINT32, 1, v.shape}};
    const dem_vtp frame = {
        .points = v.position, .point_count = VIEW_BODIES, .point_arrays = arrays, .point_array_count = 3};
    dem_field_source s = source_of(&bodies, &frame);
    check_field("velocity:z", &s, 3, v.velocity[3].z, "m/s");
    check_field("velocity:0", &s, 3, v.velocity[3].x, "m/s");
    check_field("velocity", &s, 3, v3_norm(v.velocity[3]), "m/s");
    check_field("turn:w", &s, 2, v.orientation[2].w, "");
    check_field("turn:3", &s, 2, v.orientation[2].z, "");
    check_field("template", &s, 2, v.shape[2], "");
    dem_field f;
    dem_error error;
    check_ok(dem_field_make("template", &s, &f, &error), error);
    check(f.whole && strcmp(f.title, "template") == 0);
    free(f.values);
    check_ok(dem_field_make("velocity:z", &s, &f, &error), error);
    check(!f.whole && strcmp(f.title, "velocity z") == 0);
    free(f.values);
    static const char *const wrong[] = {
        "velocity:3", "velocity:w", "velocity:", "template:x", "velocity:-1", "velocity:zz"};
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++)
        check(dem_field_make(wrong[i], &s, &f, &error) == DEM_USAGE && strstr(error.text, "component") && !f.values);
}

static void what_is_not_known_is_refused_in_words(void **state)
{
    (void)state;
    made_view v;
    dem_body_view bodies = view_bodies(&v, 3);
    dem_field_source s = source_of(&bodies, NULL);
    dem_field f;
    dem_error error;
    check(dem_field_make("sped", &s, &f, &error) == DEM_USAGE && strstr(error.text, "did you mean speed?"));
    check(dem_field_make("temperature", &s, &f, &error) == DEM_USAGE && strstr(error.text, "take one of: size"));
    bodies.coordination = NULL;
    check(dem_field_make("coordination", &s, &f, &error) == DEM_BAD_INPUT && strchr(error.text, ';'));
}

static void ranges_leave_out_what_is_hidden_or_no_number(void **state)
{
    (void)state;
    const double values[] = {3, NAN, -7, INFINITY, 12};
    const unsigned char hidden[] = {0, 0, 1, 0, 0};
    double low, high;
    dem_field_range(values, NULL, 5, &low, &high);
    check(low == -7 && high == 12);
    dem_field_range(values, hidden, 5, &low, &high);
    check(low == 3 && high == 12);
    dem_field_range(values, hidden, 0, &low, &high);
    check(low > high);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(what_is_always_known_has_its_unit),
        cmocka_unit_test(arrays_of_a_frame_are_taken_by_component),
        cmocka_unit_test(what_is_not_known_is_refused_in_words),
        cmocka_unit_test(ranges_leave_out_what_is_hidden_or_no_number),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
