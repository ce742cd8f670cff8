"""Plant b of the blind check: a second vehicle simulator by other forms, other pilots and other instruments than plant a and than rovval's own.

Frozen on 2026-11-23: the forms, sizes and instruments of this room are what sets of plant b mean, and stay as they are from that day, so that
what is tuned on one set can be checked on the next. What should be different is a third plant.

It shares with plant a what a flight takes and gives (`rovval.blind.plant.spec`) and with nobody any equation. What is other, and whose form it is:

- motion: velocities over ground and a rotation on its group, implicit midpoint by fixed-point sweeps at 50 Hz (Hairer, Lubich and Wanner 2006, II.1.3
  and IV.8), with the acceleration of the water along the vehicle's way by difference; `motion`
- resistance: power laws of speed (friction that falls with the Reynolds number, Hoerner 1965) through the file's drag at working speed and at half of it,
  sideways and vertical drag by strips (cross-flow principle, Faltinsen 1990, 6.1); `hull`
- thrust: blade lift and drag in all four quadrants (Healey, Rock, Cody, Miles and Brown 1995), tables by the angle of advance; `blades`
- water: random Fourier modes (Kraichnan 1970), Ekman's spiral (1905), tidal ellipses, JONSWAP's spectrum (Hasselmann 1973); `faults.water`
- tether: sagging line of lumps with normal and tangential drag (Irvine 1981; Driscoll, Lueck and Nahon 2000); `faults.line`
- instruments: white noise with random walk, quantisation, latency, drop-outs in bursts; `instruments`
- pilots: a joystick with reaction time and corrections, transects at a held speed, a square with stops, pirouettes, orbits, station keeping; `pilots`
"""
