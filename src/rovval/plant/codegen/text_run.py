"""Text of the kernel, second part: time, step by step, and the equations of motion at each stage of a step.

The stages of a step that begins in X0 leave Y1 = X0 + h/2 k1, Y2 = X0 + h/2 k2, Y3 = X0 + h k3 and Y4 = X0 - h/2 k4 behind it, 13 rows
each: one store a number. Then X0 + h/6 (k1 + 2 k2 + 2 k3 + k4) = X0 + ((Y1 - Y4) + (Y3 - X0) + 2 (Y2 - X0)) / 3.
"""

TEXT = '''@njit(**OPTIONS)
def run(first, last, numbers, acts, late, onset, states, start, limit, which, gain, speed, log, t, extra, geo, pairs,
        weights, dt, hold, steps, substeps, out, stopped, reason):
    """Blocks ``first`` to ``last`` of W lanes each: time runs inside the block, so that its numbers stay in the cache."""
    h, inv_dt = dt / substeps, 1.0 / dt
    m, th = aligned(TOTAL * W), aligned(3 * THS)
    la, lg = aligned(2 * LOGS * W), aligned(3 * LOGS * W)
    <<geometry>>
    for b in range(first, last):
        for c in range(ROWS * W):
            m[c] = numbers[b, c]
        for c in range(13 * W):
            m[X0 * W + c] = states[b, c]
        for c in range((TOTAL - SEEN) * W):
            m[SEEN * W + c] = 0.0
        use_extra, use_wake, use_side, pending, least = False, False, False, False, steps
        for l in range(W):
            m[ALIVE * W + l] = 1.0
            least = min(least, limit[b, l])
            use_extra = use_extra or which[b, l] >= 0
            for i in range(THRUSTERS):
                use_wake = use_wake or m[(JET + i) * W + l] != 0.0
            use_side = use_side or m[(JET + THRUSTERS) * W + l] != 0.0
            pending = pending or onset[b, l] < math.inf
        <<switches>>
        for c in range(2 * LOGS * W):  #full
            la[c] = 0.0  #full
        for c in range(3 * LOGS * W):  #full
            lg[c] = 0.0  #full
        warm(speed, t, start[b], dt, hold, m)  #full
        record(m, out, 0, b * W)
        begin = 0
        for step in range(steps):
            if step >= least:
                halt(m, stopped[b], reason[b], limit[b], step)
            if step == 0 or hold:
                logged(speed, t, start[b], step, m, 0)
            else:
                for c in range(THRUSTERS * W):
                    m[ENDS * W + c] = m[(ENDS + THRUSTERS) * W + c]
            if hold:
                for c in range(THRUSTERS * W):
                    m[(ENDS + THRUSTERS) * W + c] = m[ENDS * W + c]
            else:
                logged(speed, t, start[b], step + 1, m, 1)
            if use_log:  #full
                load_log(log, t, extra, gain[b], which[b], start[b], step, dt, la, use_extra, W, LOGS)  #full
            for sub in range(substeps):
                f0, f1 = sub / substeps, (sub + 1) / substeps
                again = 0
                if not hold and step + sub > 0:  # a step begins where the last one ended
                    again, begin = 1, 2 - begin
                for s in range(again, 3):
                    f = f0 + (f1 - f0) * 0.5 * s
                    slot = 1 + (s - 1) * (1 - begin)
                    tv = th[slot * THS : (slot + 1) * THS]
                    lv = lg[slot * LOGS * W : (slot + 1) * LOGS * W]  #full
                    for l in range(W):  #rest
                        <<wrench_at_rest>>  #rest
                    if use_log:  #full
                        for c in range(LOGS * W):  #full
                            lv[c] = la[c] + (la[LOGS * W + c] - la[c]) * f  #full
                    if use_rest:  #full
                        for i in range(THRUSTERS):  #full
                            for l in range(W):  #full
                                tau, left = m[LAG * W + l], m[(LAG + 1 + s) * W + l]  #full
                                <<thrust_with_effects>>  #full
                    else:  #full
                        for i in range(THRUSTERS):  #full
                            for l in range(W):  #full
                                tau, left = m[LAG * W + l], m[(LAG + 1 + s) * W + l]  #full
                                <<thrust_at_rest>>  #full
                    for i in range(THRUSTERS):  #law
                        for l in range(W):  #law
                            <<thrust_at_rest>>  #law
                    if use_wake:  #full
                        for c in range(pairs.shape[0]):  #full
                            row, other, first_row = 3 * pairs[c, 1] * W, 3 * pairs[c, 0] * W, (BODY + pairs[c, 1] * STRIDE) * W  #full
                            wa, ws, wake = weights[c, 0], weights[c, 1], (JET + pairs[c, 1]) * W  #full
                            for l in range(W):  #full
                                n, up = tv[row + W + l], tv[other + W + l]  #full
                                jet = (wa if up > 0.0 else ws) * min(abs(up), abs(n))  #full
                                own = 0.5 * (m[first_row + l] * (n + abs(n)) + m[first_row + W + l] * (n - abs(n)))  #full
                                tv[row + l] -= m[wake + l] * jet * own  #full
                    for l in range(W):  #state
                        <<wrench_of_thrust>>  #state
                    if use_side:  #full
                        for l in range(W):  #full
                            <<side>>  #full
                    if use_extra:  #full
                        for c in range(6 * W):  #full
                            tv[3 * THRUSTERS * W + c] += lv[5 * W + c]  #full
                if pending:  #full
                    for l in range(W):  #full
                        if lg[begin * LOGS * W + 4 * W + l] >= onset[b, l]:  #full
                            for c in range(PAYLOAD):  #full
                                m[(MASS + c) * W + l] = late[b, c * W + l]  #full
                for c in range(THRUSTERS * W):  #full
                    m[MEMORY * W + c] = m[NEXT * W + c]  #full
                for stage in range(4):
                    slot = 1 + ((stage + 1) // 2 - 1) * (1 - begin)
                    tv = th[slot * THS : (slot + 1) * THS]
                    lv = lg[slot * LOGS * W : (slot + 1) * LOGS * W]  #full
                    xs, xn = (X0 + 13 * stage) * W, (X0 + 13 * stage + 13) * W
                    reach = -0.5 * h if stage == 3 else (h if stage == 2 else 0.5 * h)
                    half = 0.5 * reach
                    <<passes>>
                    for l in range(W):
                        <<state>>
                        ur, vr, wr = u, v, w  #nominal
                        k0, k1, k2 = vn, ve, vd
                        k3 = -(qx * r_p + qy * r_q + qz * r_r)
                        k4 = qw * r_p + qy * r_r - qz * r_q
                        k5 = qw * r_q + qz * r_p - qx * r_r
                        k6 = qw * r_r + qx * r_q - qy * r_p
                        mass, c1, c2, c3 = m[MASS * W + l], m[(MASS + 1) * W + l], m[(MASS + 2) * W + l], m[(MASS + 3) * W + l]
                        i11, i12, i13 = m[(MASS + 4) * W + l], m[(MASS + 5) * W + l], m[(MASS + 6) * W + l]
                        i22, i23, i33 = m[(MASS + 7) * W + l], m[(MASS + 8) * W + l], m[(MASS + 9) * W + l]
                        l1, l2, l3 = mass * u + r_q * c3 - r_r * c2, mass * v + r_r * c1 - r_p * c3, mass * w + r_p * c2 - r_q * c1
                        h1 = c2 * w - c3 * v + i11 * r_p + i12 * r_q + i13 * r_r
                        h2 = c3 * u - c1 * w + i12 * r_p + i22 * r_q + i23 * r_r
                        h3 = c1 * v - c2 * u + i13 * r_p + i23 * r_q + i33 * r_r
                        <<momentum>>
                        <<force>>
                        net = m[RESTORING * W + l]
                        g1, g2, g3 = m[(RESTORING + 1) * W + l], m[(RESTORING + 2) * W + l], m[(RESTORING + 3) * W + l]
                        <<drag>>
                        X = X + net * r31 - r_q * s3 + r_r * s2
                        Y = Y + net * r32 - r_r * s1 + r_p * s3
                        Z = Z + net * r33 - r_p * s2 + r_q * s1
                        K = K + g2 * r33 - g3 * r32 - r_q * t3 + r_r * t2 - v * s3 + w * s2
                        M = M + g3 * r31 - g1 * r33 - r_r * t1 + r_p * t3 - w * s1 + u * s3
                        N = N + g1 * r32 - g2 * r31 - r_p * t2 + r_q * t1 - u * s2 + v * s1
                        <<acceleration>>
                        <<stage_state>>
                settle(m, stopped[b], reason[b], step)
            record(m, out, step + 1, b * W)
'''
