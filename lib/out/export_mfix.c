// MFiX glued spheres (gsp_config.csv). MFiX has no way to give mass and inertia: it sums over the spheres as if they
// did not overlap. So the head tells the density that makes the mass right, and what error the moments then have.
#include "geom/union.h"
#include "out/export_text.h"

static const char MARK[] = "# ";

// what MFiX sums: volume, centre and the diagonal of the tensor about the origin, at unit density
typedef struct sums {
    double volume, moment[3];
    dem_vec3 centre;
} sums;

static sums sum_balls(const dem_clump_def *clump)
{
    sums s = {0};
    for (size_t i = 0; i < clump->ball_count; i++) {
        dem_vec3 c = clump->balls[i].centre;
        double r = clump->balls[i].radius, v = 4 * DEM_PI / 3 * r * r * r;
        const double second[3] = {c.x * c.x, c.y * c.y, c.z * c.z};
        s.volume += v;
        s.centre = v3_along(s.centre, v, c);
        for (int k = 0; k < 3; k++)
            s.moment[k] += v * (second[(k + 1) % 3] + second[(k + 2) % 3] + 0.4 * r * r);
    }
    s.centre = v3_scale(s.centre, 1 / s.volume);
    return s;
}

static void put_errors(dem_buffer *out, const dem_clump_def *clump)
{
    sums s = sum_balls(clump);
    double density = clump->mass / s.volume, percent[3];
    for (int k = 0; k < 3; k++)
        percent[k] = 100 * (density * s.moment[k] / clump->inertia[k] - 1);
    dem_export_put_figures(out, MARK, "density to give the phase, so that the mass is right [kg/m^3]", &density, 1);
    dem_export_put_figures(out, MARK, "error the three moments of inertia then have [%]", percent, 3);
    dem_export_put_figures(out, MARK, "where the sum over the spheres has its centre, taken to be 0 [m]",
                           (double[]){s.centre.x, s.centre.y, s.centre.z}, 3);
}

static dem_status write_mfix(const dem_clump *clump, const dem_export_options *options, dem_buffer *out,
                             dem_error *error)
{
    static const char *const use[] = {
        "untested, experimental: written after its Python scripts of 2025",
        "use: copy to gsp_config.csv in the project; pid (last column) is the number of the solids phase, whose",
        "diameter (d_p0) is the bounding diameter below. Should MFiX not read it, take these comments away.",
        "MFiX has no way to give mass and inertia, it sums over the spheres with the density of the phase.",
        "rel_sa is the surface of each sphere that shows; heat conduction between the spheres is left out (-1, 0).",
        NULL};
    dem_clump_def def = dem_clump_view(clump);
    dem_ball_union u;
    DEM_TRY(dem_ball_union_compute(def.balls, def.ball_count, false, 1, &u, error));
    double d = 2 * dem_export_reach(&def);
    dem_buffer_text(out, "#version = 1\n");
    dem_export_put_head(out, &(dem_export_head){MARK, "MFiX glued sphere configuration", use, "mfix.csv"}, &def,
                        options);
    dem_export_put_figures(out, MARK, "bounding diameter [m]", &d, 1);
    put_errors(out, &def);
    dem_buffer_text(out, "x,y,z,rel_d,rel_sa,w,e,s,n,t,b,w_na,e_na,s_na,n_na,t_na,b_na,pid\n");
    for (size_t i = 0; i < def.ball_count; i++) {
        dem_ball b = def.balls[i];
        const double row[5] = {b.centre.x / d, b.centre.y / d, b.centre.z / d, 2 * b.radius / d,
                               b.radius * b.radius * u.patches[i].area / (d * d)};
        for (int k = 0; k < 5; k++) {
            dem_buffer_number(out, row[k], 17);
            dem_buffer_text(out, ",");
        }
        dem_buffer_text(out, "-1,-1,-1,-1,-1,-1,0,0,0,0,0,0,1\n");
    }
    dem_ball_union_release(&u);
    return out->failed ? dem_fail_memory(error) : DEM_OK;
}

extern const dem_exporter dem_export_mfix;
const dem_exporter dem_export_mfix = {
    .name = "mfix",
    .suffix = "mfix.csv",
    .about = "MFiX: glued sphere configuration (experimental)",
    .for_engine = true,
    .write = write_mfix,
};
