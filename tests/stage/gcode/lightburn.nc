; LightBurn-like, grbl device profile, absolute coordinates
; Bounds: X10 Y10 to X70 Y50
G00 G17 G40 G21 G54
G90
M4
; Cut @ 1500 mm/min, 60% power
M8
G0 X10Y10
; Layer C00
G1 X70S600F1500
G1 Y50
G1 X10
G1 Y10
M9
G1 S0
; Fill @ 9000 mm/min, 20% power
G0 X20 Y20
G1 X60 S200 F9000
G0 Y21
G1 X20 S200
M5
G90
; back to the finish position
G0 X0 Y0
M2
