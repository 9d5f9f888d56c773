-- Stands in for schema 14 until it comes.
SELECT 14;
