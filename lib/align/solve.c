#include <math.h>

#include "solve_internal.h"

void wh_normal_begin(wh_normal_t *normal, size_t terms) {
    normal->terms = terms;
    for (size_t i = 0; i < WH_NORMAL_TERMS; ++i) {
        normal->right[i] = 0;
        for (size_t j = 0; j < WH_NORMAL_TERMS; ++j) {
            normal->matrix[i][j] = 0;
        }
    }
}

void wh_normal_add(wh_normal_t *normal, const double *derivatives, double residual, double weight) {
    for (size_t i = 0; i < normal->terms; ++i) {
        const double weighted = weight * derivatives[i];
        normal->right[i] += weighted * residual;
        for (size_t j = i; j < normal->terms; ++j) {
            normal->matrix[i][j] += weighted * derivatives[j];
        }
    }
}

/* The upper triangle becomes U with U^T U = matrix; then U^-1 replaces it. */
static bool invert_factor(wh_normal_t *n) {
    for (size_t i = 0; i < n->terms; ++i) {
        double rest = n->matrix[i][i];
        const double whole = rest;
        for (size_t k = 0; k < i; ++k) {
            rest -= n->matrix[k][i] * n->matrix[k][i];
        }
        if (!(rest > 1e-13 * whole)) {
            return false;
        }
        const double pivot = sqrt(rest);
        n->matrix[i][i] = pivot;
        for (size_t j = i + 1; j < n->terms; ++j) {
            double sum = n->matrix[i][j];
            for (size_t k = 0; k < i; ++k) {
                sum -= n->matrix[k][i] * n->matrix[k][j];
            }
            n->matrix[i][j] = sum / pivot;
        }
    }
    for (size_t j = 0; j < n->terms; ++j) {
        const double inverse = 1 / n->matrix[j][j];
        for (size_t i = 0; i < j; ++i) {
            double sum = 0;
            for (size_t k = i; k < j; ++k) {
                sum += n->matrix[i][k] * n->matrix[k][j];
            }
            n->matrix[i][j] = -sum * inverse;
        }
        n->matrix[j][j] = inverse;
    }
    return true;
}

bool wh_normal_solve(wh_normal_t *normal) {
    if (!invert_factor(normal)) {
        return false;
    }
    /* The inverse is U^-1 U^-T. Row i is written after it was read, because entries (i, j >= i) need rows i
     * and j. */
    for (size_t i = 0; i < normal->terms; ++i) {
        for (size_t j = i; j < normal->terms; ++j) {
            double sum = 0;
            for (size_t k = j; k < normal->terms; ++k) {
                sum += normal->matrix[i][k] * normal->matrix[j][k];
            }
            normal->matrix[i][j] = sum;
        }
    }
    double solution[WH_NORMAL_TERMS];
    for (size_t i = 0; i < normal->terms; ++i) {
        solution[i] = 0;
        for (size_t j = 0; j < normal->terms; ++j) {
            const double entry = i <= j ? normal->matrix[i][j] : normal->matrix[j][i];
            solution[i] += entry * normal->right[j];
        }
    }
    for (size_t i = 0; i < normal->terms; ++i) {
        normal->right[i] = solution[i];
        for (size_t j = 0; j < i; ++j) {
            normal->matrix[i][j] = normal->matrix[j][i];
        }
    }
    return true;
}
