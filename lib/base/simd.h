/// Wide numbers: a few doubles or floats taken through the same arithmetic at once. The one place with intrinsics.
///
/// The width follows the instruction set the file is compiled for: 8 doubles (AVX-512), 4 (AVX2) or 1 (anything). All
/// widths give the same bits: + - * / sqrt and fused multiply-adds are rounded alike everywhere, they are fused only
/// where `wide_fma` (a b + c), `wide_fms` (a b - c) or `wide_fnma` (c - a b) says so, and what depends on an order is
/// defined on blocks of DEM_BLOCK_LANES whatever the width. A processor that cannot fuse does it in the library: right,
/// but slow.
///
/// Rows are 8 doubles on a 64-byte boundary. `rows_*` turns 8 rows (or DEM_WIDTH of them) into 8 columns and back.
#ifndef DEM_BASE_SIMD_H
#define DEM_BASE_SIMD_H

#include <math.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#define DEM_INLINE static inline __attribute__((always_inline))

enum { DEM_BLOCK_LANES = 8 };  ///< lanes on which orders of summation are defined
#define DEM_ROOT_BITS 0x5fe6eb50c7b537a9

#if defined(__AVX512F__) && defined(__AVX512DQ__) && defined(__AVX512VL__)
#include <immintrin.h>
enum { DEM_WIDTH = 8, DEM_WIDTH_FLOAT = 16 };
typedef __m512d wide;
typedef __mmask8 wide_mask;
typedef __m512 widef;
typedef __mmask16 widef_mask;

DEM_INLINE wide wide_all(double x)
{
    return _mm512_set1_pd(x);
}
DEM_INLINE wide wide_load(const double *p)
{
    return _mm512_loadu_pd(p);
}
DEM_INLINE void wide_store(double *p, wide a)
{
    _mm512_storeu_pd(p, a);
}
DEM_INLINE wide wide_sqrt(wide a)
{
    return _mm512_sqrt_pd(a);
}
DEM_INLINE wide wide_abs(wide a)
{
    return _mm512_abs_pd(a);
}
DEM_INLINE wide wide_fma(wide a, wide b, wide c)
{
    return _mm512_fmadd_pd(a, b, c);
}
DEM_INLINE wide wide_fms(wide a, wide b, wide c)
{
    return _mm512_fmsub_pd(a, b, c);
}
DEM_INLINE wide wide_fnma(wide a, wide b, wide c)
{
    return _mm512_fnmadd_pd(a, b, c);
}
DEM_INLINE wide wide_max(wide a, wide b)
{
    return _mm512_max_pd(a, b);
}
DEM_INLINE wide wide_min(wide a, wide b)
{
    return _mm512_min_pd(a, b);
}
DEM_INLINE wide_mask wide_less(wide a, wide b)
{
    return _mm512_cmp_pd_mask(a, b, _CMP_LT_OQ);
}
DEM_INLINE wide_mask wide_less_equal(wide a, wide b)
{
    return _mm512_cmp_pd_mask(a, b, _CMP_LE_OQ);
}
DEM_INLINE wide_mask wide_not_le(wide a, wide b)
{
    return _mm512_cmp_pd_mask(a, b, _CMP_NLE_UQ);
}
DEM_INLINE wide wide_select(wide_mask m, wide a, wide b)
{
    return _mm512_mask_blend_pd(m, b, a);
}
DEM_INLINE wide wide_or_zero(wide_mask m, wide a)
{
    return _mm512_maskz_mov_pd(m, a);
}
DEM_INLINE wide_mask wide_and(wide_mask a, wide_mask b)
{
    return a & b;
}
DEM_INLINE wide_mask wide_either(wide_mask a, wide_mask b)
{
    return a | b;
}
// the last 12 bits of each number to its front
DEM_INLINE wide wide_bits_up(wide a)
{
    return _mm512_castsi512_pd(_mm512_slli_epi64(_mm512_castpd_si512(a), 52));
}
// 1 / sqrt(a) to 3.5 %, from the bits of a: half of its exponent, and its digits a straight line
DEM_INLINE wide wide_root_guess(wide a)
{
    __m512i half = _mm512_srli_epi64(_mm512_castpd_si512(a), 1);
    return _mm512_castsi512_pd(_mm512_sub_epi64(_mm512_set1_epi64(DEM_ROOT_BITS), half));
}
DEM_INLINE unsigned wide_bits(wide_mask m)
{
    return m;
}

// pairs of half rows: {low of p, low of q}
DEM_INLINE wide halves(const double *p, const double *q)
{
    return _mm512_insertf64x4(_mm512_castpd256_pd512(_mm256_load_pd(p)), _mm256_load_pd(q), 1);
}
// four columns of eight half rows
DEM_INLINE void columns4(const double *const *row, wide *out)
{
    wide z0 = halves(row[0], row[2]), z1 = halves(row[1], row[3]), z2 = halves(row[4], row[6]);
    wide z3 = halves(row[5], row[7]);
    wide a = _mm512_unpacklo_pd(z0, z1), b = _mm512_unpackhi_pd(z0, z1);
    wide c = _mm512_unpacklo_pd(z2, z3), d = _mm512_unpackhi_pd(z2, z3);
    out[0] = _mm512_shuffle_f64x2(a, c, 0x88);
    out[1] = _mm512_shuffle_f64x2(b, d, 0x88);
    out[2] = _mm512_shuffle_f64x2(a, c, 0xdd);
    out[3] = _mm512_shuffle_f64x2(b, d, 0xdd);
}
DEM_INLINE void transpose8(wide *r)
{
    wide t[8], u[8];
    for (int i = 0; i < 4; i++) {
        t[2 * i] = _mm512_unpacklo_pd(r[2 * i], r[2 * i + 1]);
        t[2 * i + 1] = _mm512_unpackhi_pd(r[2 * i], r[2 * i + 1]);
    }
    for (int i = 0; i < 2; i++) {
        u[4 * i] = _mm512_shuffle_f64x2(t[4 * i], t[4 * i + 2], 0x88);
        u[4 * i + 1] = _mm512_shuffle_f64x2(t[4 * i + 1], t[4 * i + 3], 0x88);
        u[4 * i + 2] = _mm512_shuffle_f64x2(t[4 * i], t[4 * i + 2], 0xdd);
        u[4 * i + 3] = _mm512_shuffle_f64x2(t[4 * i + 1], t[4 * i + 3], 0xdd);
    }
    for (int i = 0; i < 4; i++) {
        r[i] = _mm512_shuffle_f64x2(u[i], u[4 + i], 0x88);
        r[4 + i] = _mm512_shuffle_f64x2(u[i], u[4 + i], 0xdd);
    }
}
DEM_INLINE void rows_load4(const double *base, size_t stride, const uint32_t *index, wide out[4])
{
    const double *row[8];
    for (int i = 0; i < 8; i++)
        row[i] = base + stride * index[i];
    columns4(row, out);
}
DEM_INLINE void rows_load(const double *base, size_t stride, const uint32_t *index, wide out[8])
{
    const double *low[8], *high[8];
    for (int i = 0; i < 8; i++) {
        low[i] = base + stride * index[i];
        high[i] = low[i] + 4;
    }
    columns4(low, out);
    columns4(high, out + 4);
}
DEM_INLINE void rows_load_next4(const double *base, size_t stride, wide out[4])
{
    const double *row[8];
    for (int i = 0; i < 8; i++)
        row[i] = base + stride * (size_t)i;
    columns4(row, out);
}
// half rows, two to a register: of rows 0 and 2, 4 and 6, 1 and 3, 5 and 7
DEM_INLINE void half_rows(const wide *c, wide out[4])
{
    const __m512i low = _mm512_setr_epi64(0, 1, 8, 9, 2, 3, 10, 11);
    const __m512i high = _mm512_setr_epi64(4, 5, 12, 13, 6, 7, 14, 15);
    wide even = _mm512_unpacklo_pd(c[0], c[1]), even_more = _mm512_unpacklo_pd(c[2], c[3]);
    wide odd = _mm512_unpackhi_pd(c[0], c[1]), odd_more = _mm512_unpackhi_pd(c[2], c[3]);
    out[0] = _mm512_permutex2var_pd(even, low, even_more);
    out[1] = _mm512_permutex2var_pd(even, high, even_more);
    out[2] = _mm512_permutex2var_pd(odd, low, odd_more);
    out[3] = _mm512_permutex2var_pd(odd, high, odd_more);
}
// to memory in halves, which needs fewer shuffles than whole rows
DEM_INLINE void rows_store_next4(double *base, size_t stride, const wide *columns)
{
    wide h[4];
    half_rows(columns, h);
    for (size_t i = 0; i < 8; i++) {
        wide pair = h[2 * (i & 1) + i / 4];
        _mm256_store_pd(base + stride * i, i & 2 ? _mm512_extractf64x4_pd(pair, 1) : _mm512_castpd512_pd256(pair));
    }
}
// One row after the other: an index may stand twice. (Adding by halves, which takes a third of the shuffles, is no
// faster: it is the rows that are waited for.)
DEM_INLINE void rows_add(double *base, const uint32_t *index, wide *columns, const bool minus)
{
    transpose8(columns);
    for (int i = 0; i < 8; i++) {
        double *p = base + 8 * (size_t)index[i];
        _mm512_store_pd(p, minus ? _mm512_load_pd(p) - columns[i] : _mm512_load_pd(p) + columns[i]);
    }
}

DEM_INLINE widef widef_all(float x)
{
    return _mm512_set1_ps(x);
}
DEM_INLINE widef widef_load(const float *p)
{
    return _mm512_loadu_ps(p);
}
DEM_INLINE void widef_store(float *p, widef a)
{
    _mm512_storeu_ps(p, a);
}
DEM_INLINE widef widef_max(widef a, widef b)
{
    return _mm512_max_ps(a, b);
}
DEM_INLINE widef widef_min(widef a, widef b)
{
    return _mm512_min_ps(a, b);
}
DEM_INLINE widef widef_sqrt(widef a)
{
    return _mm512_sqrt_ps(a);
}
DEM_INLINE widef_mask widef_below(widef a, widef b)
{
    return _mm512_cmp_ps_mask(a, b, _CMP_LT_OQ);
}
DEM_INLINE widef_mask widef_up_to(widef a, widef b)
{
    return _mm512_cmp_ps_mask(a, b, _CMP_LE_OQ);
}
DEM_INLINE widef_mask widef_and(widef_mask a, widef_mask b)
{
    return a & b;
}
DEM_INLINE widef_mask widef_either(widef_mask a, widef_mask b)
{
    return a | b;
}
DEM_INLINE widef widef_select(widef_mask m, widef a, widef b)
{
    return _mm512_mask_blend_ps(m, b, a);
}
DEM_INLINE uint32_t widef_bits(widef_mask m)
{
    return m;
}
DEM_INLINE float widef_highest(widef a)
{
    return _mm512_reduce_max_ps(a);
}
DEM_INLINE float widef_lowest(widef a)
{
    return _mm512_reduce_min_ps(a);
}
DEM_INLINE void widef_pack(float *p, uint32_t bits, widef a)
{
    _mm512_mask_compressstoreu_ps(p, (__mmask16)bits, a);
}
DEM_INLINE void indices_pack(uint32_t *p, uint32_t bits, uint32_t first)
{
    const __m512i ramp = _mm512_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15);
    _mm512_mask_compressstoreu_epi32(p, (__mmask16)bits, _mm512_add_epi32(ramp, _mm512_set1_epi32((int)first)));
}

#elif defined(__AVX2__) && defined(__FMA__)
#include <immintrin.h>
enum { DEM_WIDTH = 4, DEM_WIDTH_FLOAT = 8 };
typedef __m256d wide;
typedef __m256d wide_mask;
typedef __m256 widef;
typedef __m256 widef_mask;

DEM_INLINE wide wide_all(double x)
{
    return _mm256_set1_pd(x);
}
DEM_INLINE wide wide_load(const double *p)
{
    return _mm256_loadu_pd(p);
}
DEM_INLINE void wide_store(double *p, wide a)
{
    _mm256_storeu_pd(p, a);
}
DEM_INLINE wide wide_sqrt(wide a)
{
    return _mm256_sqrt_pd(a);
}
DEM_INLINE wide wide_abs(wide a)
{
    return _mm256_andnot_pd(_mm256_set1_pd(-0.0), a);
}
DEM_INLINE wide wide_fma(wide a, wide b, wide c)
{
    return _mm256_fmadd_pd(a, b, c);
}
DEM_INLINE wide wide_fms(wide a, wide b, wide c)
{
    return _mm256_fmsub_pd(a, b, c);
}
DEM_INLINE wide wide_fnma(wide a, wide b, wide c)
{
    return _mm256_fnmadd_pd(a, b, c);
}
DEM_INLINE wide wide_max(wide a, wide b)
{
    return _mm256_max_pd(a, b);
}
DEM_INLINE wide wide_min(wide a, wide b)
{
    return _mm256_min_pd(a, b);
}
DEM_INLINE wide_mask wide_less(wide a, wide b)
{
    return _mm256_cmp_pd(a, b, _CMP_LT_OQ);
}
DEM_INLINE wide_mask wide_less_equal(wide a, wide b)
{
    return _mm256_cmp_pd(a, b, _CMP_LE_OQ);
}
DEM_INLINE wide_mask wide_not_le(wide a, wide b)
{
    return _mm256_cmp_pd(a, b, _CMP_NLE_UQ);
}
DEM_INLINE wide wide_select(wide_mask m, wide a, wide b)
{
    return _mm256_blendv_pd(b, a, m);
}
DEM_INLINE wide wide_or_zero(wide_mask m, wide a)
{
    return _mm256_and_pd(m, a);
}
DEM_INLINE wide_mask wide_and(wide_mask a, wide_mask b)
{
    return _mm256_and_pd(a, b);
}
DEM_INLINE wide_mask wide_either(wide_mask a, wide_mask b)
{
    return _mm256_or_pd(a, b);
}
DEM_INLINE wide wide_bits_up(wide a)
{
    return _mm256_castsi256_pd(_mm256_slli_epi64(_mm256_castpd_si256(a), 52));
}
DEM_INLINE wide wide_root_guess(wide a)
{
    __m256i half = _mm256_srli_epi64(_mm256_castpd_si256(a), 1);
    return _mm256_castsi256_pd(_mm256_sub_epi64(_mm256_set1_epi64x(DEM_ROOT_BITS), half));
}
DEM_INLINE unsigned wide_bits(wide_mask m)
{
    return (unsigned)_mm256_movemask_pd(m);
}

DEM_INLINE void transpose4(wide *r)
{
    wide a = _mm256_unpacklo_pd(r[0], r[1]), b = _mm256_unpackhi_pd(r[0], r[1]);
    wide c = _mm256_unpacklo_pd(r[2], r[3]), d = _mm256_unpackhi_pd(r[2], r[3]);
    r[0] = _mm256_permute2f128_pd(a, c, 0x20);
    r[1] = _mm256_permute2f128_pd(b, d, 0x20);
    r[2] = _mm256_permute2f128_pd(a, c, 0x31);
    r[3] = _mm256_permute2f128_pd(b, d, 0x31);
}
DEM_INLINE void rows_load4(const double *base, size_t stride, const uint32_t *index, wide out[4])
{
    for (int i = 0; i < 4; i++)
        out[i] = _mm256_load_pd(base + stride * index[i]);
    transpose4(out);
}
DEM_INLINE void rows_load(const double *base, size_t stride, const uint32_t *index, wide out[8])
{
    rows_load4(base, stride, index, out);
    rows_load4(base + 4, stride, index, out + 4);
}
DEM_INLINE void rows_load_next4(const double *base, size_t stride, wide out[4])
{
    for (int i = 0; i < 4; i++)
        out[i] = _mm256_load_pd(base + stride * (size_t)i);
    transpose4(out);
}
DEM_INLINE void rows_store_next4(double *base, size_t stride, const wide *columns)
{
    wide row[4] = {columns[0], columns[1], columns[2], columns[3]};
    transpose4(row);
    for (int i = 0; i < 4; i++)
        _mm256_store_pd(base + stride * (size_t)i, row[i]);
}
DEM_INLINE void rows_add(double *base, const uint32_t *index, wide *columns, const bool minus)
{
    transpose4(columns);
    transpose4(columns + 4);
    for (int i = 0; i < 4; i++)
        for (int half = 0; half < 2; half++) {
            double *p = base + 8 * (size_t)index[i] + 4 * half;
            wide more = columns[4 * half + i];
            _mm256_store_pd(p, minus ? _mm256_load_pd(p) - more : _mm256_load_pd(p) + more);
        }
}

DEM_INLINE widef widef_all(float x)
{
    return _mm256_set1_ps(x);
}
DEM_INLINE widef widef_load(const float *p)
{
    return _mm256_loadu_ps(p);
}
DEM_INLINE void widef_store(float *p, widef a)
{
    _mm256_storeu_ps(p, a);
}
DEM_INLINE widef widef_max(widef a, widef b)
{
    return _mm256_max_ps(a, b);
}
DEM_INLINE widef widef_min(widef a, widef b)
{
    return _mm256_min_ps(a, b);
}
DEM_INLINE widef widef_sqrt(widef a)
{
    return _mm256_sqrt_ps(a);
}
DEM_INLINE widef_mask widef_below(widef a, widef b)
{
    return _mm256_cmp_ps(a, b, _CMP_LT_OQ);
}
DEM_INLINE widef_mask widef_up_to(widef a, widef b)
{
    return _mm256_cmp_ps(a, b, _CMP_LE_OQ);
}
DEM_INLINE widef_mask widef_and(widef_mask a, widef_mask b)
{
    return _mm256_and_ps(a, b);
}
DEM_INLINE widef_mask widef_either(widef_mask a, widef_mask b)
{
    return _mm256_or_ps(a, b);
}
DEM_INLINE widef widef_select(widef_mask m, widef a, widef b)
{
    return _mm256_blendv_ps(b, a, m);
}
DEM_INLINE uint32_t widef_bits(widef_mask m)
{
    return (uint32_t)_mm256_movemask_ps(m);
}
DEM_INLINE float widef_highest(widef a)
{
    __m128 h = _mm_max_ps(_mm256_castps256_ps128(a), _mm256_extractf128_ps(a, 1));
    h = _mm_max_ps(h, _mm_movehl_ps(h, h));
    return _mm_cvtss_f32(_mm_max_ss(h, _mm_shuffle_ps(h, h, 1)));
}
DEM_INLINE float widef_lowest(widef a)
{
    __m128 h = _mm_min_ps(_mm256_castps256_ps128(a), _mm256_extractf128_ps(a, 1));
    h = _mm_min_ps(h, _mm_movehl_ps(h, h));
    return _mm_cvtss_f32(_mm_min_ss(h, _mm_shuffle_ps(h, h, 1)));
}
DEM_INLINE void widef_pack(float *p, uint32_t bits, widef a)
{
    float lane[8];
    _mm256_storeu_ps(lane, a);
    for (; bits; bits &= bits - 1)
        *p++ = lane[__builtin_ctz(bits)];
}
DEM_INLINE void indices_pack(uint32_t *p, uint32_t bits, uint32_t first)
{
    for (; bits; bits &= bits - 1)
        *p++ = first + (uint32_t)__builtin_ctz(bits);
}

#else
enum { DEM_WIDTH = 1, DEM_WIDTH_FLOAT = 1 };
typedef double wide;
typedef bool wide_mask;
typedef float widef;
typedef int32_t widef_mask;  // as wide as the numbers beside it

DEM_INLINE wide wide_all(double x)
{
    return x;
}
DEM_INLINE wide wide_load(const double *p)
{
    return *p;
}
DEM_INLINE void wide_store(double *p, wide a)
{
    *p = a;
}
DEM_INLINE wide wide_sqrt(wide a)
{
    return sqrt(a);
}
DEM_INLINE wide wide_abs(wide a)
{
    return fabs(a);
}
DEM_INLINE wide wide_fma(wide a, wide b, wide c)
{
    return __builtin_fma(a, b, c);
}
DEM_INLINE wide wide_fms(wide a, wide b, wide c)
{
    return __builtin_fma(a, b, -c);
}
DEM_INLINE wide wide_fnma(wide a, wide b, wide c)
{
    return __builtin_fma(-a, b, c);
}
DEM_INLINE wide wide_max(wide a, wide b)
{
    return a > b ? a : b;
}  // as the instructions have it: b if unordered
DEM_INLINE wide wide_min(wide a, wide b)
{
    return a < b ? a : b;
}
DEM_INLINE wide_mask wide_less(wide a, wide b)
{
    return a < b;
}
DEM_INLINE wide_mask wide_less_equal(wide a, wide b)
{
    return a <= b;
}
DEM_INLINE wide_mask wide_not_le(wide a, wide b)
{
    return !(a <= b);
}
DEM_INLINE wide wide_select(wide_mask m, wide a, wide b)
{
    return m ? a : b;
}
DEM_INLINE wide wide_or_zero(wide_mask m, wide a)
{
    return m ? a : 0;
}
DEM_INLINE wide_mask wide_and(wide_mask a, wide_mask b)
{
    return a && b;
}
DEM_INLINE wide_mask wide_either(wide_mask a, wide_mask b)
{
    return a || b;
}
DEM_INLINE wide wide_bits_up(wide a)
{
    uint64_t bits;
    memcpy(&bits, &a, sizeof bits);
    bits <<= 52;
    memcpy(&a, &bits, sizeof a);
    return a;
}
DEM_INLINE wide wide_root_guess(wide a)
{
    int64_t bits;
    memcpy(&bits, &a, sizeof bits);
    bits = DEM_ROOT_BITS - (int64_t)((uint64_t)bits >> 1);
    memcpy(&a, &bits, sizeof a);
    return a;
}
DEM_INLINE unsigned wide_bits(wide_mask m)
{
    return m;
}

DEM_INLINE void rows_load4(const double *base, size_t stride, const uint32_t *index, wide out[4])
{
    memcpy(out, base + stride * *index, 4 * sizeof *out);
}
DEM_INLINE void rows_load(const double *base, size_t stride, const uint32_t *index, wide out[8])
{
    memcpy(out, base + stride * *index, 8 * sizeof *out);
}
DEM_INLINE void rows_load_next4(const double *base, size_t stride, wide out[4])
{
    (void)stride;
    memcpy(out, base, 4 * sizeof *out);
}
DEM_INLINE void rows_store_next4(double *base, size_t stride, const wide *columns)
{
    (void)stride;
    memcpy(base, columns, 4 * sizeof *columns);
}
DEM_INLINE void rows_add(double *base, const uint32_t *index, wide *columns, const bool minus)
{
    for (int k = 0; k < 8; k++)
        base[8 * (size_t)*index + (size_t)k] += minus ? -columns[k] : columns[k];
}

DEM_INLINE widef widef_all(float x)
{
    return x;
}
DEM_INLINE widef widef_load(const float *p)
{
    return *p;
}
DEM_INLINE void widef_store(float *p, widef a)
{
    *p = a;
}
DEM_INLINE widef widef_max(widef a, widef b)
{
    return a > b ? a : b;
}
DEM_INLINE widef widef_min(widef a, widef b)
{
    return a < b ? a : b;
}
DEM_INLINE widef widef_sqrt(widef a)
{
    return sqrtf(a);
}
DEM_INLINE widef_mask widef_below(widef a, widef b)
{
    return a < b;
}
DEM_INLINE widef_mask widef_up_to(widef a, widef b)
{
    return a <= b;
}
DEM_INLINE widef_mask widef_and(widef_mask a, widef_mask b)
{
    return a & b;
}
DEM_INLINE widef_mask widef_either(widef_mask a, widef_mask b)
{
    return a | b;
}
DEM_INLINE widef widef_select(widef_mask m, widef a, widef b)
{
    return m ? a : b;
}
DEM_INLINE uint32_t widef_bits(widef_mask m)
{
    return m;
}
DEM_INLINE float widef_highest(widef a)
{
    return a;
}
DEM_INLINE float widef_lowest(widef a)
{
    return a;
}
DEM_INLINE void widef_pack(float *p, uint32_t bits, widef a)
{
    if (bits)
        *p = a;
}
DEM_INLINE void indices_pack(uint32_t *p, uint32_t bits, uint32_t first)
{
    if (bits)
        *p = first;
}
#endif

/// Rows that stand one after the other, whole.
DEM_INLINE void rows_load_next(const double *base, size_t stride, wide out[8])
{
    rows_load_next4(base, stride, out);
    rows_load_next4(base + 4, stride, out + 4);
}
DEM_INLINE void rows_store_next(double *base, size_t stride, const wide *columns)
{
    rows_store_next4(base, stride, columns);
    rows_store_next4(base + 4, stride, columns + 4);
}

/// 1 / sqrt(a) and sqrt(a) of a >= 1e-300, to 1.6 units of the last place: a guess from the bits, the polynomial of
/// degree 3 in h = 1 - a y^2 that is best for the h it leaves (7.5e-7), and a step of third order (1e-18). A root and a
/// division keep the divider of Sapphire Rapids busy for 34 cycles, this takes 15 instructions; it is as long to wait
/// for, though.
DEM_INLINE wide wide_roots(wide a, wide *root)
{
    wide y = wide_root_guess(a), r = a * y, h = wide_fnma(r, y, wide_all(1)), h2 = h * h;
    wide p = wide_fma(wide_all(0.31309030646501512), h, wide_all(0.37628288010567418));
    p = wide_fma(p, h2, wide_fma(wide_all(0.50000030742833212), h, wide_all(0.9999992490700369)));
    y = y * p;
    r = r * p;
    h = wide_fnma(r, y, wide_all(1));
    p = wide_fma(wide_all(0.375), h, wide_all(0.5));
    *root = wide_fma(r * h, p, r);
    return wide_fma(y * h, p, y);
}

/// 1 / sqrt(a), likewise.
DEM_INLINE wide wide_rsqrt(wide a)
{
    wide root;
    return wide_roots(a, &root);
}

/// sqrt(a) of a >= 0, likewise, but that of nothing is 1e-150; and 1 / sqrt(a).
DEM_INLINE wide wide_root(wide a, wide *inverse)
{
    wide root;
    *inverse = wide_roots(a + wide_all(1e-300), &root);
    return root;
}

/// 2^k of whole -1022 <= k <= 1023: the last bits of 1.5 2^52 + x are those of the whole number x.
DEM_INLINE wide wide_power_of_two(wide k)
{
    return wide_bits_up(k + wide_all(0x1.8p52 + 1023));
}

/// e^x of x <= 0, to a rounding or two: x = k ln 2 + r, and Taylor's series up to r^13 for |r| <= ln 2 / 2. 0 from -708
/// on.
DEM_INLINE wide wide_exp(wide x)
{
    wide round = wide_all(0x1.8p52), least = wide_all(-708);
    wide_mask some = wide_less(least, x);
    x = wide_max(x, least);
    wide k = wide_fma(x, wide_all(1.4426950408889634), round) - round;
    // ln 2 in two parts, the first with zeros behind, so that k times it is exact
    wide r = wide_fnma(k, wide_all(0x1.62e42fefap-1), x), sum = wide_all(1.0 / 6227020800);
    r = wide_fnma(k, wide_all(0x1.cf79abc9e3b3ap-40), r);
    static const double one_over_factorial[] = {
        1.0 / 479001600, 1.0 / 39916800, 1.0 / 3628800, 1.0 / 362880, 1.0 / 40320, 1.0 / 5040, 1.0 / 720,
        1.0 / 120,       1.0 / 24,       1.0 / 6,       0.5,          1,           1};
    for (int i = 0; i < 13; i++)
        sum = wide_fma(sum, r, wide_all(one_over_factorial[i]));
    return wide_or_zero(some, sum * wide_power_of_two(k));
}

/// The bits of the first `count` lanes, or of all.
DEM_INLINE uint32_t first_lanes(widef_mask m, size_t count)
{
    uint32_t bits = widef_bits(m);
    return count >= DEM_WIDTH_FLOAT ? bits : bits & ((1u << count) - 1);
}

#endif
