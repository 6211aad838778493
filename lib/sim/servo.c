#include "sim/servo.h"

#include "base/status.h"
#include "sim/mesh_wall.h"

// ---- areas

static double distance_of_planes(const dem_walls *walls, const uint32_t pair[2])
{
    const double *a = walls->rows + DEM_WALL_ROW * pair[0], *b = walls->rows + DEM_WALL_ROW * pair[1];
    return fabs(v3_dot(v3(a[0], a[1], a[2]), v3(b[4] - a[4], b[5] - a[5], b[6] - a[6])));
}

static bool has_extents(const dem_servo_def *s)
{
    bool both = true;
    for (int k = 0; k < 2; k++)
        both = both && (s->extent[k].length > 0 || s->extent[k].walls[0] != s->extent[k].walls[1]);
    return both;
}

double dem_servo_area(const dem_walls *walls, size_t wall)
{
    const dem_servo_def *s = &walls->items[wall].servo;
    if (s->area > 0 || !has_extents(s))
        return s->area;
    double area = 1;
    for (int k = 0; k < 2; k++)
        area *= s->extent[k].length > 0 ? s->extent[k].length : distance_of_planes(walls, s->extent[k].walls);
    return area;
}

// seen along a direction: of an open sheet, or of one side of a closed mesh
static double shadow_of_mesh(const dem_mesh_wall *mesh, dem_vec3 direction)
{
    double ahead = 0, behind = 0;
    for (size_t i = 0; i < mesh->mesh.triangle_count; i++) {
        const uint32_t *t = &mesh->mesh.triangles[3 * i];
        const dem_vec3 *v = mesh->mesh.vertices;
        double a = v3_dot(v3_cross(v3_sub(v[t[1]], v[t[0]]), v3_sub(v[t[2]], v[t[0]])), direction) / 2;
        *(a > 0 ? &ahead : &behind) += fabs(a);
    }
    return larger(ahead, behind);
}

static dem_status prepare(dem_walls *walls, size_t i, dem_error *error)
{
    dem_wall *w = &walls->items[i];
    dem_servo_def *s = &w->servo;
    if (!(s->target >= 0 && s->gain > 0 && s->gain <= 1 && s->max_velocity > 0 && v3_norm2(s->direction) > 0 &&
          s->mass >= 0 && s->damping_rate >= 0 && isfinite(s->target) && isfinite(s->max_velocity)))
        return dem_fail(error, DEM_BAD_INPUT,
                        "the servo of wall \"%.60s\" cannot be; it needs a direction, a target from 0, a gain up to 1 "
                        "and a largest velocity",
                        w->name);
    s->direction = v3_unit(s->direction);
    for (int k = 0; k < 2; k++)
        for (int e = 0; e < 2; e++)
            if (s->extent[k].walls[e] >= walls->count || (has_extents(s) && !(s->extent[k].length > 0) &&
                                                          walls->items[s->extent[k].walls[e]].form != DEM_FORM_PLANE))
                return dem_fail(error, DEM_BAD_INPUT,
                                "an extent of the servo of wall \"%.60s\" is not between two planes; name two, or "
                                "give a length",
                                w->name);
    if (s->partner > walls->count || (s->partner && !walls->items[s->partner - 1].servo.on))
        return dem_fail(error, DEM_BAD_INPUT,
                        "the partner of the servo of wall \"%.60s\" is no servo wall; give it a servo, too", w->name);
    if (!(s->area > 0) && !has_extents(s) && w->mesh)
        s->area = shadow_of_mesh(w->mesh, s->direction);
    else if (!(s->area > 0) && !has_extents(s))
        s->area = dem_surface_shadow(&w->surface, s->direction);
    if (s->stress && !(dem_servo_area(walls, i) > 0))
        return dem_fail(error, DEM_BAD_INPUT,
                        "the servo of wall \"%.60s\" has a stress but no area; give \"area\" or \"extents\"", w->name);
    return DEM_OK;
}

dem_status dem_servo_prepare(dem_walls *walls, dem_error *error)
{
    for (size_t i = 0; i < walls->count; i++)
        if (walls->items[i].servo.on)
            DEM_TRY(prepare(walls, i, error));
    return DEM_OK;
}

double dem_servo_most(const dem_walls *walls)
{
    double most = 0;
    for (size_t i = 0; i < walls->count; i++)
        if (walls->items[i].servo.on)
            most = larger(most, walls->items[i].servo.max_velocity);
    return most;
}

// ---- in each step

static void gather_segment(dem_world *w, const dem_contact_columns *c, const dem_segment *s, dem_servo_sum *sums)
{
    for (size_t at = s->begin; at < s->end; at++) {
        // idle contacts name the walls behind the last
        size_t wall = c->sphere_b[at];
        if (wall >= w->walls.count || !w->walls.items[wall].servo.on)
            continue;
        dem_vec3 force = v3(c->reaction[0][at], c->reaction[1][at], c->reaction[2][at]);
        sums[wall].force += v3_dot(force, w->walls.items[wall].servo.direction);
        sums[wall].hardness += c->hardness[at];
    }
}

void dem_servo_gather(dem_world *w, size_t begin, size_t end)
{
    for (size_t i = begin; i < end; i++) {
        dem_servo_sum *sums = w->servo_sums + i * w->walls.count;
        for (size_t k = 0; k < w->walls.count; k++)
            sums[k] = (dem_servo_sum){0, 0};
        for (int form = 0; form < DEM_WALL_FORMS; form++)
            if (w->wall_contacts[form].segments)
                gather_segment(w, &w->wall_contacts[form].columns, &w->wall_contacts[form].segments[i], sums);
    }
}

static dem_servo_sum sum_of(const dem_world *w, size_t wall)
{
    dem_servo_sum sum = {0, 0};
    for (size_t i = 0; i < w->segment_count; i++) {
        sum.force += w->servo_sums[i * w->walls.count + wall].force;
        sum.hardness += w->servo_sums[i * w->walls.count + wall].hardness;
    }
    return sum;
}

static double next_speed(const dem_world *w, size_t i, const dem_servo_sum *sum)
{
    const dem_wall *wall = &w->walls.items[i];
    const dem_servo_def *s = &wall->servo;
    double h = w->next_step, target = s->stress ? s->target * dem_servo_area(&w->walls, i) : s->target;
    double missing = target - sum->force, most = s->max_velocity, speed = missing > 0 ? most : -most;
    if (s->mass > 0) {
        double mass = larger(s->mass, h * h * sum->hardness);
        speed = (wall->speed + h * missing / mass) / (1 + h * s->damping_rate);
    } else if (fabs(missing) * s->gain < most * h * sum->hardness)
        speed = s->gain * missing / (h * sum->hardness);
    else if (missing == 0)
        speed = 0;
    return smaller(larger(speed, -most), most);
}

void dem_servo_move(dem_world *w)
{
    double fastest = 0, h = w->next_step;
    for (size_t i = 0; i < w->walls.count; i++) {
        dem_wall *wall = &w->walls.items[i];
        if (!wall->servo.on)
            continue;
        dem_servo_sum own = sum_of(w, i), sum = own;
        if (wall->servo.partner) {
            dem_servo_sum other = sum_of(w, wall->servo.partner - 1);
            sum = (dem_servo_sum){(own.force + other.force) / 2, (own.hardness + other.hardness) / 2};
        }
        double speed = next_speed(w, i, &sum);
        // the contact pass took the work of this force at the old velocity for the half step to come, too
        w->push_work += h / 2 * own.force * (speed - wall->speed);
        wall->speed = speed;
        wall->travel += h * speed;
        fastest = larger(fastest, fabs(speed));
    }
    // the step was begun as if the servos went as fast as they may
    w->wall_path -= h * (w->sweep_speed - (w->sweep_least + fastest));
}
