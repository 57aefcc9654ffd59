/* SPDX-License-Identifier: MIT */
#include "base/ode_pool.h"

/* ---- vectors ---- */

N_Vector imp_ode_pool_vector(imp_ode_pool *pool)
{
    imp_ode_vector *free_one = &pool->vectors[pool->vector_count - 1];
    for (int i = pool->vector_count - 1; i >= 0; i--)
        if (!pool->vectors[i].taken) free_one = &pool->vectors[i];
    pool->spent = pool->spent || free_one->taken;
    free_one->taken = true;
    free_one->content.data = free_one->data;
    if (++pool->taken > pool->most) pool->most = pool->taken;
    return &free_one->vector;
}

static N_Vector clone_vector(N_Vector like) { return imp_ode_pool_vector(((imp_ode_vector *)(void *)like)->pool); }

static void return_vector(N_Vector vector)
{
    imp_ode_vector *own = (imp_ode_vector *)(void *)vector;
    own->taken = false;
    own->pool->taken--;
}

static struct _generic_N_Vector_Ops make_vector_ops(void)
{
    return (struct _generic_N_Vector_Ops){.nvgetvectorid = N_VGetVectorID_Serial,
                                          .nvclone = clone_vector,
                                          .nvcloneempty = clone_vector,
                                          .nvdestroy = return_vector,
                                          .nvspace = N_VSpace_Serial,
                                          .nvgetarraypointer = N_VGetArrayPointer_Serial,
                                          .nvsetarraypointer = N_VSetArrayPointer_Serial,
                                          .nvgetlength = N_VGetLength_Serial,
                                          .nvlinearsum = N_VLinearSum_Serial,
                                          .nvconst = N_VConst_Serial,
                                          .nvprod = N_VProd_Serial,
                                          .nvdiv = N_VDiv_Serial,
                                          .nvscale = N_VScale_Serial,
                                          .nvabs = N_VAbs_Serial,
                                          .nvinv = N_VInv_Serial,
                                          .nvaddconst = N_VAddConst_Serial,
                                          .nvdotprod = N_VDotProd_Serial,
                                          .nvmaxnorm = N_VMaxNorm_Serial,
                                          .nvwrmsnorm = N_VWrmsNorm_Serial,
                                          .nvmin = N_VMin_Serial};
}

static bool make_vectors(imp_ode_pool *pool, imp_arena *arena, SUNContext sundials, int count)
{
    pool->vectors = imp_arena_take(arena, (size_t)count, sizeof *pool->vectors);
    pool->vector_ops = make_vector_ops();
    for (; pool->vectors && pool->vector_count < count; pool->vector_count++) {
        imp_ode_vector *own = &pool->vectors[pool->vector_count];
        *own = (imp_ode_vector){.vector = {&own->content, &pool->vector_ops, sundials}, .pool = pool};
        own->data = imp_arena_take(arena, (size_t)pool->capacity, sizeof(double));
        if (!own->data) return false;
    }
    return pool->vectors != NULL;
}

/* ---- matrices ---- */

SUNMatrix imp_ode_pool_matrix(imp_ode_pool *pool)
{
    imp_ode_matrix *free_one = &pool->matrices[IMP_ODE_MATRICES - 1];
    for (int i = IMP_ODE_MATRICES - 1; i >= 0; i--)
        if (!pool->matrices[i].taken) free_one = &pool->matrices[i];
    pool->spent = pool->spent || free_one->taken;
    free_one->taken = true;
    return &free_one->matrix;
}

static SUNMatrix clone_matrix(SUNMatrix like) { return imp_ode_pool_matrix(((imp_ode_matrix *)(void *)like)->pool); }
static void return_matrix(SUNMatrix matrix) { ((imp_ode_matrix *)(void *)matrix)->taken = false; }
static int keep_solver(SUNLinearSolver solver) { return (void)solver, 0; }

static bool make_matrices(imp_ode_pool *pool, imp_arena *arena, SUNContext sundials)
{
    const size_t n = (size_t)pool->capacity;
    pool->matrix_ops = (struct _generic_SUNMatrix_Ops){.getid = SUNMatGetID_Dense,
                                                       .clone = clone_matrix,
                                                       .destroy = return_matrix,
                                                       .zero = SUNMatZero_Dense,
                                                       .copy = SUNMatCopy_Dense,
                                                       .scaleadd = SUNMatScaleAdd_Dense,
                                                       .scaleaddi = SUNMatScaleAddI_Dense,
                                                       .space = SUNMatSpace_Dense};
    for (int i = 0; i < IMP_ODE_MATRICES; i++) {
        imp_ode_matrix *own = &pool->matrices[i];
        *own = (imp_ode_matrix){.matrix = {&own->content, &pool->matrix_ops, sundials}, .pool = pool};
        own->content.data = imp_arena_take(arena, n * n, sizeof(double));
        own->content.cols = imp_arena_take(arena, n, sizeof *own->content.cols);
        if (!own->content.data || !own->content.cols) return false;
    }
    pool->solver_ops = (struct _generic_SUNLinearSolver_Ops){.gettype = SUNLinSolGetType_Dense,
                                                             .getid = SUNLinSolGetID_Dense,
                                                             .initialize = SUNLinSolInitialize_Dense,
                                                             .setup = SUNLinSolSetup_Dense,
                                                             .solve = SUNLinSolSolve_Dense,
                                                             .lastflag = SUNLinSolLastFlag_Dense,
                                                             .space = SUNLinSolSpace_Dense,
                                                             .free = keep_solver};
    pool->solver_content.pivots = imp_arena_take(arena, n, sizeof *pool->solver_content.pivots);
    pool->solver = (struct _generic_SUNLinearSolver){&pool->solver_content, &pool->solver_ops, sundials};
    return pool->solver_content.pivots != NULL;
}

/* ---- both ---- */

void imp_ode_pool_resize(imp_ode_pool *pool, int size)
{
    pool->size = size;
    for (int i = 0; i < pool->vector_count; i++) pool->vectors[i].content.length = size;
    for (int i = 0; i < IMP_ODE_MATRICES; i++) {
        struct _SUNMatrixContent_Dense *content = &pool->matrices[i].content;
        if (!content->data) continue;
        content->M = content->N = size;
        content->ldata = (sunindextype)size * size;
        for (int j = 0; j < size; j++) content->cols[j] = content->data + (size_t)j * (size_t)size;
    }
    pool->solver_content.N = size;
}

bool imp_ode_pool_make(imp_ode_pool *pool, imp_arena *arena, SUNContext sundials, int capacity, int vectors,
                       bool with_matrices)
{
    *pool = (imp_ode_pool){.capacity = capacity};
    if (!make_vectors(pool, arena, sundials, vectors)) return false;
    if (with_matrices && !make_matrices(pool, arena, sundials)) return false;
    imp_ode_pool_resize(pool, capacity);
    return true;
}

void imp_ode_pool_free(imp_ode_pool *pool, imp_arena *arena)
{
    for (int i = 0; i < pool->vector_count; i++) imp_arena_give(arena, pool->vectors[i].data);
    imp_arena_give(arena, pool->vectors);
    for (int i = 0; i < IMP_ODE_MATRICES; i++) {
        imp_arena_give(arena, pool->matrices[i].content.data);
        imp_arena_give(arena, pool->matrices[i].content.cols);
    }
    imp_arena_give(arena, pool->solver_content.pivots);
    *pool = (imp_ode_pool){0};
}
