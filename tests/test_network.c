// The network of contacts as lines in files.
#include "folder.h"
#include "vtp.h"
#include "worlds.h"

#include "out/network.h"

static const double R = 0.01;

// two spheres that touch across a periodic side, one of which lies on a plane: gravity and friction
static dem_world *touching_world(void)
{
    model *m = model_new();
    m->scene.domain = (dem_domain_def){{0, -1, -1}, {0.1, 1, 1}, {true, false, false}, DEM_LEAVING_IGNORE};
    m->laws[0].friction = DEM_FRICTION_LINEAR;
    m->laws[0].friction_coefficient = 0.5;
    uint32_t ball = model_sphere(m, R);
    model_body(m, ball, v3(0.004, 0, R - 1e-4))->velocity = v3(0, 0.1, 0);
    model_body(m, ball, v3(0.0845, 0, R));
    model_body(m, ball, v3(0.05, 0, 0.5));
    model_plane(m, v3(0, 0, 0), v3(0, 0, 1));
    dem_world *w = model_world(m, 1);
    model_free(m);
    run_steps(w, 5);
    measured(w);
    return w;
}

static dem_network *opened(const char *directory, double resume)
{
    const dem_domain_def domain = {{0, -1, -1}, {0.1, 1, 1}, {true, false, false}, DEM_LEAVING_IGNORE};
    dem_network *network;
    dem_error error;
    check_ok(dem_network_open(directory, "contacts", &domain, NULL, resume, &network, &error), error);
    return network;
}

static void put(dem_network *network, const dem_world *w, int first, int last)
{
    dem_body_view bodies = dem_world_bodies(w);
    size_t count;
    const dem_contact *contacts = dem_world_contacts(w, &count);
    dem_error error;
    for (int i = first; i < last; i++)
        check_ok(dem_network_write(network, 0.01 * i, &bodies, contacts, i % 2 ? 0 : count, &error), error);
}

static void a_contact_is_a_line_with_its_forces(void **state)
{
    (void)state;
    dem_world *w = touching_world();
    dem_network *network = opened(in_folder("one"), NAN);
    put(network, w, 0, 1);
    dem_network_close(network);
    dem_buffer file = content(in_folder("one/frames/contacts_000000.vtp"));
    vtp_check_blocks(&file);
    check(vtp_count(&file, "NumberOfPoints") == 4 && vtp_count(&file, "NumberOfLines") == 2);
    size_t count;
    const dem_contact *c = dem_world_contacts(w, &count);
    check(count == 2);
    dem_vec3 points[4], force[2];
    double normal[2], friction[2], overlap[2];
    int32_t kind[2], body[2], other[2], wall[2];
#define GET(section, name, type, width, into)                                                                          \
    memcpy(into, vtp_array(&file, section, name, type, width, sizeof into), sizeof into)
    GET("Points", "Points", "Float64", 3, points);
    GET("CellData", "force", "Float64", 3, force);
    GET("CellData", "normal_force", "Float64", 1, normal);
    GET("CellData", "friction_force", "Float64", 1, friction);
    GET("CellData", "overlap", "Float64", 1, overlap);
    GET("CellData", "kind", "Int32", 1, kind);
    GET("CellData", "body", "Int32", 1, body);
    GET("CellData", "other", "Int32", 1, other);
    GET("CellData", "wall", "Int32", 1, wall);
#undef GET
    dem_body_view b = dem_world_bodies(w);
    for (int i = 0; i < 2; i++) {
        bool on_wall = c[i].other == UINT32_MAX;
        check(kind[i] == on_wall && body[i] == (int32_t)c[i].body && other[i] == (on_wall ? -1 : (int32_t)c[i].other));
        check(wall[i] == (on_wall ? 0 : -1));
        check(normal[i] == c[i].normal_force && overlap[i] == c[i].overlap && normal[i] > 0);
        check(friction[i] == v3_norm(c[i].friction_force) && friction[i] > 0);
        check_vec(force[i], v3_sub(c[i].friction_force, v3_scale(c[i].normal, normal[i])), 1e-15 * normal[i]);
        check_vec(points[2 * i], b.position[body[i]], 0);
        // the other end: on the wall, or the image of a centre that is along the normal
        dem_vec3 l = v3_sub(points[2 * i + 1], points[2 * i]);
        check_vec(v3_unit(l), c[i].normal, 1e-12);
        check_close(v3_norm(l), (on_wall ? R : 2 * R) - overlap[i], 1e-12);
    }
    dem_buffer_release(&file);
    dem_world_destroy(w);
}

static void a_resumed_network_is_that_of_a_straight_run(void **state)
{
    (void)state;
    dem_world *w = touching_world();
    dem_network *network = opened(in_folder("straight"), NAN);
    put(network, w, 0, 6);
    dem_network_close(network);
    network = opened(in_folder("resumed"), NAN);
    put(network, w, 0, 5);
    dem_network_close(network);
    network = opened(in_folder("resumed"), 0.02);
    check(!exists(in_folder("resumed/frames/contacts_000003.vtp")));
    put(network, w, 3, 6);
    dem_network_close(network);
    check_same_file(in_folder("straight/contacts.pvd"), in_folder("resumed/contacts.pvd"));
    check_same_file(in_folder("straight/frames/contacts_000004.vtp"), in_folder("resumed/frames/contacts_000004.vtp"));
    // and a new run leaves nothing of them, but what is not its own
    FILE *f = fopen(in_folder("resumed/frames/contacts_old.vtp"), "w");
    fclose(f);
    network = opened(in_folder("resumed"), NAN);
    check(!exists(in_folder("resumed/contacts.pvd")) && !exists(in_folder("resumed/frames/contacts_000000.vtp")));
    check(exists(in_folder("resumed/frames/contacts_old.vtp")));
    dem_network_close(network);
    dem_world_destroy(w);
}

static void where_nothing_can_be_written_it_says_so(void **state)
{
    (void)state;
    FILE *f = fopen(in_folder("file"), "w");
    fclose(f);
    dem_network *network;
    dem_error error;
    const dem_domain_def domain = {0};
    check(dem_network_open(in_folder("file"), "contacts", &domain, NULL, NAN, &network, &error) == DEM_CANNOT_WRITE);
    check(!network);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_contact_is_a_line_with_its_forces),
        cmocka_unit_test(a_resumed_network_is_that_of_a_straight_run),
        cmocka_unit_test(where_nothing_can_be_written_it_says_so),
    };
    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
