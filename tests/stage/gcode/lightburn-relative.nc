; relative moves
G00 G17 G40 G21 G54
G91
M4
; Cut @ 1200 mm/min, 80% power
M8
G0X15Y12
; Layer C01
G1X30S800F1200
G1Y25
G1X-30
G1Y-25
G1S0
M9
M5
G90
G0 X0 Y0
M2
