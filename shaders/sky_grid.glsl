// Cells of the sky, as many as sky_columns and sky_rows of background.hpp.
#define SKY_COLUMNS 24
#define SKY_ROWS 32
