/* SPDX-License-Identifier: MIT
 *
 * ode_pool: CVODE's vectors, matrices and dense solver on arena memory. SUNDIALS takes what a clone is from the vector
 * that it clones, and stops the process where a clone is NULL; so all clones are made beforehand, and a clone is never
 * NULL. Their operations are those of SUNDIALS' serial vectors and dense matrices: the numbers are the same to the bit.
 * Internal to ode_cvode.c; SUNDIALS 6.x or 7.x.
 */
#ifndef IMP_ODE_POOL_H
#define IMP_ODE_POOL_H

#include <cvode/cvode.h>
#include <nvector/nvector_serial.h>
#include <sunlinsol/sunlinsol_dense.h>
#include <sunmatrix/sunmatrix_dense.h>
#include "base/arena.h"

typedef struct imp_ode_vector { /* what SUNDIALS sees stands first, so that its pointers are ours */
    struct _generic_N_Vector vector;
    struct _N_VectorContent_Serial content;
    struct imp_ode_pool *pool;
    double *data; /* its own; SUNDIALS may point the content elsewhere */
    bool taken;
} imp_ode_vector;

typedef struct imp_ode_matrix {
    struct _generic_SUNMatrix matrix;
    struct _SUNMatrixContent_Dense content;
    struct imp_ode_pool *pool;
    bool taken;
} imp_ode_matrix;

enum { IMP_ODE_MATRICES = 2 }; /* the Jacobian, and CVODE's copy of it */

typedef struct imp_ode_pool {
    int size, capacity; /* components now, and at most */
    imp_ode_vector *vectors;
    int vector_count;
    imp_ode_matrix matrices[IMP_ODE_MATRICES];
    struct _generic_SUNLinearSolver solver;
    struct _SUNLinearSolverContent_Dense solver_content;
    struct _generic_N_Vector_Ops vector_ops;
    struct _generic_SUNMatrix_Ops matrix_ops;
    struct _generic_SUNLinearSolver_Ops solver_ops;
    int taken, most; /* vectors handed out; the most there were at once */
    bool spent;      /* more was asked for than was made: what came is shared, and the integrator must not go on */
} imp_ode_pool;

/* `vectors` of them, and with_matrices those and the solver, all for `capacity` components. False: no memory (what was
 * taken stays in the arena's books). */
bool imp_ode_pool_make(imp_ode_pool *pool, imp_arena *arena, SUNContext sundials, int capacity, int vectors,
                       bool with_matrices);
void imp_ode_pool_free(imp_ode_pool *pool, imp_arena *arena);
/* So many components from now on, 1 to the capacity, in everything that was handed out too. */
void imp_ode_pool_resize(imp_ode_pool *pool, int size);

N_Vector imp_ode_pool_vector(imp_ode_pool *pool);
SUNMatrix imp_ode_pool_matrix(imp_ode_pool *pool);

#endif
