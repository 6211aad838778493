// The XML names every array with its place in the raw block at the end of the file. The blocks follow in the same
// order, each led by its size. One walk over the arrays serves for both.
#include "out/vtp.h"

#include <math.h>

enum { CHUNK = 1024 };  // numbers of cells that are made at a time

typedef struct writer {
    dem_buffer *out;
    const dem_vtp *vtp;
    bool raw;         // the blocks, not the XML
    uint64_t offset;  // of the next block
} writer;

const dem_vtp_kind dem_vtp_kinds[DEM_VTP_TYPES] = {[DEM_VTP_FLOAT64] = {"Float64", 8},
                                                   [DEM_VTP_FLOAT32] = {"Float32", 4},
                                                   [DEM_VTP_INT32] = {"Int32", 4},
                                                   [DEM_VTP_UINT32] = {"UInt32", 4},
                                                   [DEM_VTP_INT64] = {"Int64", 8}};

static void put_xml(writer *w, const char *text)
{
    if (!w->raw)
        dem_buffer_text(w->out, text);
}

// the tag of an array, or the size in front of its block
static void put_head(writer *w, const dem_vtp_array *a, bool field, uint64_t bytes)
{
    if (w->raw) {
        dem_buffer_bytes(w->out, &bytes, sizeof bytes);
        return;
    }
    dem_buffer_print(w->out, "<DataArray type=\"%s\" Name=\"%s\" NumberOfComponents=\"%d\"", dem_vtp_kinds[a->type].name,
                     a->name, a->width);
    if (field)
        dem_buffer_text(w->out, " NumberOfTuples=\"1\"");
    dem_buffer_print(w->out, " format=\"appended\" offset=\"%llu\"/>\n", (unsigned long long)w->offset);
    w->offset += sizeof bytes + bytes;
}

static void put_array(writer *w, const dem_vtp_array *a, bool field, size_t tuples)
{
    size_t bytes = tuples * (size_t)a->width * dem_vtp_kinds[a->type].bytes;
    put_head(w, a, field, bytes);
    if (w->raw)
        dem_buffer_bytes(w->out, a->data, bytes);
}

// `count` whole numbers: those of `list`, or without one step, 2 step, ... from `first` on
static void put_numbers(writer *w, const char *name, const uint32_t *list, size_t count, int64_t first, int64_t step)
{
    put_head(w, &(dem_vtp_array){name, DEM_VTP_INT64, 1, NULL}, false, count * sizeof(int64_t));
    for (size_t begin = 0; w->raw && begin < count; begin += CHUNK) {
        int64_t chunk[CHUNK];
        size_t size = count - begin < CHUNK ? count - begin : CHUNK;
        for (size_t i = 0; i < size; i++)
            chunk[i] = list ? list[begin + i] : first + step * (int64_t)(begin + i);
        dem_buffer_bytes(w->out, chunk, size * sizeof *chunk);
    }
}

static void put_cells(writer *w, const char *kind, const uint32_t *list, size_t count, size_t corners)
{
    if (count == 0)
        return;
    if (!w->raw)
        dem_buffer_print(w->out, "<%s>\n", kind);
    put_numbers(w, "connectivity", list, corners * count, 0, 1);
    put_numbers(w, "offsets", NULL, count, (int64_t)corners, (int64_t)corners);
    if (!w->raw)
        dem_buffer_print(w->out, "</%s>\n", kind);
}

static void put_fields(writer *w)
{
    put_xml(w, "<FieldData>\n");
    if (!isnan(w->vtp->time))
        put_array(w, &(dem_vtp_array){"TimeValue", DEM_VTP_FLOAT64, 1, &w->vtp->time}, true, 1);
    for (size_t i = 0; i < w->vtp->field_count; i++)
        put_array(w, &w->vtp->fields[i], true, 1);
    put_xml(w, "</FieldData>\n");
}

static void put_piece(writer *w)
{
    const dem_vtp *v = w->vtp;
    size_t vertices = v->vertices ? v->point_count : 0;
    if (!w->raw)
        dem_buffer_print(w->out,
                         "<Piece NumberOfPoints=\"%zu\" NumberOfVerts=\"%zu\" NumberOfLines=\"%zu\" "
                         "NumberOfStrips=\"0\" NumberOfPolys=\"%zu\">\n<Points>\n",
                         v->point_count, vertices, v->line_count, v->triangle_count);
    put_array(w, &(dem_vtp_array){"Points", DEM_VTP_FLOAT64, 3, v->points}, false, v->point_count);
    put_xml(w, "</Points>\n<PointData");
    if (v->scalars && !w->raw)
        dem_buffer_print(w->out, " Scalars=\"%s\"", v->scalars);
    put_xml(w, ">\n");
    for (size_t i = 0; i < v->point_array_count; i++)
        put_array(w, &v->point_arrays[i], false, v->point_count);
    put_xml(w, "</PointData>\n<CellData>\n");
    for (size_t i = 0; i < v->cell_array_count; i++)
        put_array(w, &v->cell_arrays[i], false, vertices + v->line_count + v->triangle_count);
    put_xml(w, "</CellData>\n");
    put_cells(w, "Verts", NULL, vertices, 1);
    put_cells(w, "Lines", v->lines, v->line_count, 2);
    put_cells(w, "Polys", v->triangles, v->triangle_count, 3);
    put_xml(w, "</Piece>\n");
}

void dem_vtp_put(dem_buffer *out, const dem_vtp *vtp)
{
    const uint16_t probe = 1;
    writer w = {.out = out, .vtp = vtp};
    dem_buffer_print(
        out,
        "<?xml version=\"1.0\"?>\n"
        "<VTKFile type=\"PolyData\" version=\"1.0\" byte_order=\"%s\" header_type=\"UInt64\">\n<PolyData>\n",
        *(const unsigned char *)&probe ? "LittleEndian" : "BigEndian");
    put_fields(&w);
    put_piece(&w);
    dem_buffer_text(out, "</PolyData>\n<AppendedData encoding=\"raw\">\n_");
    w.raw = true;
    put_fields(&w);
    put_piece(&w);
    dem_buffer_text(out, "\n</AppendedData>\n</VTKFile>\n");
}

dem_status dem_vtp_queue(dem_file_queue *queue, const char *path, const dem_vtp *vtp, dem_error *error)
{
    dem_buffer out = {0};
    dem_vtp_put(&out, vtp);
    return dem_file_queue_put(queue, path, &out, error);
}

dem_status dem_vtp_write(const char *path, const dem_vtp *vtp, dem_error *error)
{
    return dem_vtp_queue(NULL, path, vtp, error);
}
