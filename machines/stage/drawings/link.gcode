; A link plate: relative moves, rounded corners, a slot, two holes, an inch arc.
G21 G91 G17 F600
G0 X15 Y20
G1 X90
G3 X10 Y10 I0 J10       ; corners
G1 Y40
G3 X-10 Y10 I-10 J0
G1 X-90
G3 X-10 Y-10 I0 J-10
G1 Y-40
G3 X10 Y-10 R10
G0 X0 Y30               ; left hole
G0 X2.5
G2 I6.35 J0
G0 X30 Y-7.5            ; slot
G1 X30
G3 Y15 R7.5
G1 X-30
G3 Y-15 R7.5
G20                     ; right hole in inches
G90
G0 X4.0748 Y1.9685
G2 I-0.25 J0
G21
G0 X15 Y20
M2
