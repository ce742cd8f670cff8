/* The nominal plant (7 thrusters, diagonal added mass and drag, full 6 x 6 inverse) in plain C, structure of arrays: the yardstick of the
   batch kernel. Same equations, Runge-Kutta 4, blocks of W lanes with time inside; gcc -O3 -march=native -ffp-contract=fast. */
#include <math.h>
#include <string.h>
#define W 16
#define K 7
#define ROWS (31 + 4 + 18 + 8 * K)
#define ROW(a, i) ((a) + (i) * W)

static void derivative(const double *restrict p, const double *restrict x0, const double *restrict xs, double *restrict xn, double *restrict acc,
                       const double *restrict tau, double weight, double reach) {
    for (int l = 0; l < W; l++) {
#define P(i) p[(i) * W + l]
#define X(i) xs[(i) * W + l]
        double qw = X(3), qx = X(4), qy = X(5), qz = X(6), u = X(7), v = X(8), w = X(9), a = X(10), b = X(11), c = X(12), k[13];
        double r31 = 2 * (qx * qz - qy * qw), r32 = 2 * (qy * qz + qx * qw), r33 = 1 - 2 * (qx * qx + qy * qy);
        k[0] = (1 - 2 * (qy * qy + qz * qz)) * u + 2 * (qx * qy - qz * qw) * v + 2 * (qx * qz + qy * qw) * w;
        k[1] = 2 * (qx * qy + qz * qw) * u + (1 - 2 * (qx * qx + qz * qz)) * v + 2 * (qy * qz - qx * qw) * w;
        k[2] = r31 * u + r32 * v + r33 * w;
        k[3] = -0.5 * (qx * a + qy * b + qz * c);
        k[4] = 0.5 * (qw * a + qy * c - qz * b);
        k[5] = 0.5 * (qw * b + qz * a - qx * c);
        k[6] = 0.5 * (qw * c + qx * b - qy * a);
        double m = P(0), c1 = P(1), c2 = P(2), c3 = P(3);
        double l1 = m * u + b * c3 - c * c2, l2 = m * v + c * c1 - a * c3, l3 = m * w + a * c2 - b * c1;
        double h1 = c2 * w - c3 * v + P(4) * a + P(5) * b + P(6) * c;
        double h2 = c3 * u - c1 * w + P(5) * a + P(7) * b + P(8) * c;
        double h3 = c1 * v - c2 * u + P(6) * a + P(8) * b + P(9) * c;
        double a0 = P(35) * u, a1 = P(36) * v, a2 = P(37) * w, a3 = P(38) * a, a4 = P(39) * b, a5 = P(40) * c;
        double net = P(31), g1 = P(32), g2 = P(33), g3 = P(34), f[6];
#define D(i, n) ((P(41 + i) + P(47 + i) * fabs(n)) * (n))
#define T(i) tau[(i) * W + l]
        f[0] = T(0) + net * r31 - D(0, u) - (b * (l3 + a2) - c * (l2 + a1));
        f[1] = T(1) + net * r32 - D(1, v) - (c * (l1 + a0) - a * (l3 + a2));
        f[2] = T(2) + net * r33 - D(2, w) - (a * (l2 + a1) - b * (l1 + a0));
        f[3] = T(3) - (v * l3 - w * l2) - (v * a2 - w * a1) + g2 * r33 - g3 * r32 - D(3, a) - (b * (h3 + a5) - c * (h2 + a4));
        f[4] = T(4) - (w * l1 - u * l3) - (w * a0 - u * a2) + g3 * r31 - g1 * r33 - D(4, b) - (c * (h1 + a3) - a * (h3 + a5));
        f[5] = T(5) - (u * l2 - v * l1) - (u * a1 - v * a0) + g1 * r32 - g2 * r31 - D(5, c) - (a * (h2 + a4) - b * (h1 + a3));
#define M(i) P(10 + i)
        k[7] = M(0) * f[0] + M(1) * f[1] + M(2) * f[2] + M(3) * f[3] + M(4) * f[4] + M(5) * f[5];
        k[8] = M(1) * f[0] + M(6) * f[1] + M(7) * f[2] + M(8) * f[3] + M(9) * f[4] + M(10) * f[5];
        k[9] = M(2) * f[0] + M(7) * f[1] + M(11) * f[2] + M(12) * f[3] + M(13) * f[4] + M(14) * f[5];
        k[10] = M(3) * f[0] + M(8) * f[1] + M(12) * f[2] + M(15) * f[3] + M(16) * f[4] + M(17) * f[5];
        k[11] = M(4) * f[0] + M(9) * f[1] + M(13) * f[2] + M(16) * f[3] + M(18) * f[4] + M(19) * f[5];
        k[12] = M(5) * f[0] + M(10) * f[1] + M(14) * f[2] + M(17) * f[3] + M(19) * f[4] + M(20) * f[5];
        for (int i = 0; i < 13; i++) {
            acc[i * W + l] += weight * k[i];
            xn[i * W + l] = x0[i * W + l] + reach * k[i];
        }
    }
}

/* speed (samples, K) rev/s linear between samples; numbers (blocks, ROWS, W); states (blocks, 13, W) in and out; out (lanes, samples, 13). */
void run(int first, int last, const double *numbers, double *states, const long *start, const double *speed, double h, int steps, int substeps, double *out) {
    double x[13 * W], xs[13 * W], xn[13 * W], acc[13 * W], n0[K * W], n1[K * W], tau[3][6 * W];
    for (int block = first; block < last; block++) {
        const double *p = numbers + (long)block * ROWS * W;
        memcpy(x, states + (long)block * 13 * W, sizeof x);
        for (int l = 0; l < W; l++)
            for (int i = 0; i < K; i++) n1[i * W + l] = speed[start[block * W + l] * K + i];
        for (int step = 0; step < steps; step++) {
            memcpy(n0, n1, sizeof n0);
            for (int l = 0; l < W; l++)
                for (int i = 0; i < K; i++) n1[i * W + l] = speed[(start[block * W + l] + step + 1) * K + i];
            for (int sub = 0; sub < substeps; sub++) {
            for (int s = 0; s < 3; s++)
                for (int l = 0; l < W; l++) {
                    double f[6] = {0};
                    for (int i = 0; i < K; i++) {
                        const double *t = p + (53 + 8 * i) * W + l;
                        double n = n0[i * W + l] + (n1[i * W + l] - n0[i * W + l]) * (sub + 0.5 * s) / substeps;
                        double ahead = 0.5 * (fabs(n) + n), astern = 0.5 * (fabs(n) - n), thrust = t[0] * ahead * ahead - t[W] * astern * astern;
                        for (int c = 0; c < 6; c++) f[c] += thrust * t[(2 + c) * W];
                    }
                    for (int c = 0; c < 6; c++) tau[s][c * W + l] = f[c];
                }
            memcpy(xs, x, sizeof x);
            memcpy(acc, x, sizeof x);
            derivative(p, x, xs, xn, acc, tau[0], h / 6, 0.5 * h);
            derivative(p, x, xn, xs, acc, tau[1], h / 3, 0.5 * h);
            derivative(p, x, xs, xn, acc, tau[1], h / 3, h);
            derivative(p, x, xn, xs, acc, tau[2], h / 6, h);
            for (int l = 0; l < W; l++) {
                double inverse = 1 / sqrt(acc[3 * W + l] * acc[3 * W + l] + acc[4 * W + l] * acc[4 * W + l] + acc[5 * W + l] * acc[5 * W + l] + acc[6 * W + l] * acc[6 * W + l]);
                for (int c = 3; c < 7; c++) acc[c * W + l] *= inverse;
            }
            memcpy(x, acc, sizeof x);
            }
            for (int l = 0; l < W; l++)
                for (int c = 0; c < 13; c++) out[((long)(block * W + l) * steps + step) * 13 + c] = x[c * W + l];
        }
        memcpy(states + (long)block * 13 * W, x, sizeof x);
    }
}
